// SPDX-License-Identifier: MIT OR Apache-2.0
//! OBJ files through `tobj`.
//!
//! `tobj` 4.0.5 does well on clean files and surprises on others, so it never sees the file itself: a [`Feed`] reads
//! the logical lines, checks them and hands on a plain dialect. What the feed mends or refuses, and why:
//!
//! - A corner without `vt` or `vn` gets those of the corner before it once the file has any. The feed puts an entry for
//!   "missing" first in both lists and refers such corners to it; all other indices move up by one. What is no finite
//!   number, or an index of what does not exist, is missing too.
//! - Single precision is not enough for texture coordinates far from 0. The feed keeps them, and gives `tobj` their
//!   numbers in their place.
//! - `l` makes polygons of lines, an index 0 means "none" for `vt` and `vn`, an index far below zero wraps around:
//!   lines and points are counted and left out, indices are checked against what is defined so far.
//! - Faces of a material that no MTL file defines lose the material's name. Names of groups and materials are handed
//!   on as numbers, and each material is "defined" where it is first used; MTL files are read afterwards.
//! - Nor is it enough for positions far from the origin: what is given as `origin` is taken off before they are rounded.
//! - Continued lines, CR and a byte order mark, colours behind positions, `vt` with one coordinate: put right.

use std::collections::HashMap;
use std::io::{self, BufRead, Read};
use std::path::Path;

use glam::{DVec2, DVec3};

use super::LoadOptions;
use super::lines::{LONGEST_KEY, LogicalLines, MAX_OBJ_BYTES, keyword, lower_case, name_text, without_comment, words};
use super::locate;
use super::normals::Smoothing;
use super::options::reserve;
use super::origin;
use super::source::Source;
use super::unused::Tally;
use crate::error::Remedy;
use crate::monitor::Monitor;
use crate::scene::{MAX_COORDINATE, UnusedKey};
use crate::{Error, Result};

/// What stands for "the file has none" in the list of normals.
pub(super) const MISSING: f32 = f32::MAX;

/// Texture coordinates from here on are read in double precision: single precision has steps of a hundredth of a texel.
pub(super) const FAR_TEXCOORD: f64 = 64.0;

/// Numbers of texture coordinates are handed on as two whole numbers, one counting so many.
const NUMBERS_AT_ONCE: usize = 1 << 20;

/// Bytes that the feed keeps ready: few, since they are copied.
const READY_BYTES: usize = 32 << 10;

/// An OBJ file as `tobj` gives it, with the names that stand behind its numbers.
#[derive(Debug)]
pub(super) struct ObjFile {
    /// One for each run of faces of one group and material. Name: a number, index into `groups`. Texture coordinates:
    /// see [`texcoord`].
    pub models: Vec<tobj::Model>,
    /// Texture coordinates; the first stands for "missing".
    pub texcoords: Vec<DVec2>,
    /// Names of OBJ objects and groups.
    pub groups: Vec<String>,
    /// Names of materials in order of first use, each with the line of that use. `tobj`'s material ids are indices.
    pub materials: Vec<(String, usize)>,
    /// The `mtllib` arguments with their lines.
    pub libraries: Vec<(String, usize)>,
    /// Groups that were left and taken up again under the same name, in order of appearance.
    pub reopened_groups: Vec<String>,
    /// Smoothing groups: from which face on (counting all of `models`) each holds. Empty if the file has none.
    pub smoothing: Vec<(u64, Smoothing)>,
    /// What was left out.
    pub warnings: Vec<String>,
    /// Keys that were not used.
    pub unused_keys: Vec<UnusedKey>,
}

/// The texture coordinates of a corner: `index` is `tobj`'s, into those of `mesh`, and `all` those of the file. `None`:
/// the corner has none.
pub(super) fn texcoord(all: &[DVec2], mesh: &tobj::Mesh, index: u32) -> Option<DVec2> {
    let at = index as usize * 2;
    let number = mesh.texcoords[at] as usize * NUMBERS_AT_ONCE + mesh.texcoords[at + 1] as usize;
    if number == 0 { None } else { all.get(number).copied().filter(|t| t.is_finite()) }
}

/// Reads the OBJ file at `path`, with `origin` taken off all positions.
pub(super) fn read(
    source: &Source,
    path: &Path,
    origin: DVec3,
    options: &LoadOptions,
    monitor: &Monitor,
) -> Result<ObjFile> {
    let mut feed = Feed::new(LogicalLines::open(source, path, MAX_OBJ_BYTES)?, origin, options, monitor);
    let define = |name: &Path| {
        let name = name.display().to_string();
        let material = tobj::Material { name: name.clone(), ..Default::default() };
        Ok((vec![material], HashMap::from([(name, 0)])))
    };
    // Options at their defaults: separate indices, polygons whole.
    let loaded = tobj::load_obj_buf(&mut feed, &tobj::LoadOptions::default(), define);
    if let Some(error) = feed.error {
        return Err(error);
    }
    let models = match loaded {
        Ok((models, _)) => models,
        Err(e) => return Err(locate::bad_number(source, path).unwrap_or_else(|| unexplained(path, e))),
    };
    let warnings = feed.warnings();
    Ok(ObjFile {
        models,
        texcoords: feed.texcoords,
        groups: feed.groups.names.into_iter().map(|(name, _)| name).collect(),
        materials: feed.materials.names,
        libraries: feed.libraries,
        reopened_groups: feed.reopened_groups,
        smoothing: feed.smoothing,
        warnings,
        unused_keys: feed.unused.into_keys(),
    })
}

/// An error of `tobj` for which no line could be found.
fn unexplained(path: &Path, error: tobj::LoadError) -> Error {
    Error::scene(path.display().to_string(), format!("not a readable OBJ file: {error}"))
}

/// Names in order of first appearance, with the line of that appearance.
#[derive(Default)]
struct Names {
    names: Vec<(String, usize)>,
    ids: HashMap<String, usize>,
}

impl Names {
    /// The number of `name`, and whether it is new.
    fn number(&mut self, name: String, line: usize) -> (usize, bool) {
        if let Some(&id) = self.ids.get(&name) {
            return (id, false);
        }
        let id = self.names.len();
        self.ids.insert(name.clone(), id);
        self.names.push((name, line));
        (id, true)
    }
}

/// How many entries of each kind have been defined so far, and whether their list has begun in what `tobj` reads.
#[derive(Default)]
struct Defined {
    positions: u64,
    texcoords: u64,
    normals: u64,
}

/// The reader that `tobj` reads from.
struct Feed<'a> {
    lines: LogicalLines,
    monitor: &'a Monitor,
    /// Plain OBJ text, handed out from `at` on.
    ready: Vec<u8>,
    at: usize,
    error: Option<Error>,
    options: &'a LoadOptions,
    origin: DVec3,
    defined: Defined,
    texcoords: Vec<DVec2>,
    groups: Names,
    group: usize,
    /// Faces since the last line that opened a group.
    faces_in_group: u64,
    /// By group number: it has faces.
    group_has_faces: Vec<bool>,
    /// By group number: it is in `reopened_groups`.
    group_reopened: Vec<bool>,
    reopened_groups: Vec<String>,
    materials: Names,
    libraries: Vec<(String, usize)>,
    /// Faces so far.
    faces: u64,
    smoothing: Vec<(u64, Smoothing)>,
    unused: Tally,
    /// Count and first line of: lines and points, faces with fewer than three corners, free-form geometry.
    lines_and_points: (u64, usize),
    small_faces: (u64, usize),
    free_form: (u64, usize),
    /// And of texture coordinates and normals that are no numbers, and of indices of such that do not exist.
    bad_texcoords: (u64, usize),
    bad_normals: (u64, usize),
    bad_indices: (u64, usize),
}

/// Whether reading goes on.
enum Step {
    More,
    End,
}

impl<'a> Feed<'a> {
    fn new(lines: LogicalLines, origin: DVec3, options: &'a LoadOptions, monitor: &'a Monitor) -> Self {
        let unused = Tally::new(lines.path());
        let mut feed = Feed {
            lines,
            monitor,
            ready: Vec::with_capacity(READY_BYTES * 2),
            at: 0,
            error: None,
            options,
            origin,
            defined: Defined::default(),
            texcoords: vec![DVec2::NAN],
            groups: Names::default(),
            group: 0,
            faces_in_group: 0,
            group_has_faces: Vec::new(),
            group_reopened: Vec::new(),
            reopened_groups: Vec::new(),
            materials: Names::default(),
            libraries: Vec::new(),
            faces: 0,
            smoothing: Vec::new(),
            unused,
            lines_and_points: (0, 0),
            small_faces: (0, 0),
            free_form: (0, 0),
            bad_texcoords: (0, 0),
            bad_normals: (0, 0),
            bad_indices: (0, 0),
        };
        // Faces before any group.
        feed.open_group(String::new(), 0);
        feed
    }

    /// Turns one logical line into plain OBJ.
    fn step(&mut self) -> Result<Step> {
        let Some((line_number, line)) = self.lines.next_line()? else { return Ok(Step::End) };
        let (written, rest) = keyword(line);
        let mut lower = [0; LONGEST_KEY];
        let key = lower_case(written, &mut lower);
        let rest = if matches!(key, b"v" | b"vt" | b"vn" | b"f" | b"s") { without_comment(rest) } else { rest };
        match key {
            b"v" => {
                self.defined.positions += 1;
                let kept = match words(rest).count() {
                    // x y z, or with a weight
                    3 | 4 => rest,
                    // with a colour, which is left out
                    6 | 7 => {
                        self.unused.count("vertex colours", line_number);
                        first_words(rest, 3)
                    }
                    n => {
                        let message =
                            format!("`v` with {n} numbers; 3 are right (or 4 with a weight, 6 with a colour)");
                        return Err(syntax(self.lines.path(), line_number, message));
                    }
                };
                match origin::moved(kept, self.origin) {
                    Some(moved) => push_line(&mut self.ready, b"v ", moved.as_bytes()),
                    None => push_line(&mut self.ready, b"v ", kept),
                }
            }
            b"vt" => {
                if self.defined.texcoords == 0 {
                    begin_list(&mut self.ready, self.group, self.faces_in_group, "vt 0 0\n");
                }
                self.defined.texcoords += 1;
                let number = self.texcoords.len();
                if number >= MOST_TEXCOORDS {
                    return Err(too_many(self.lines.path(), number, "texture coordinates", MOST_TEXCOORDS));
                }
                let texcoord = parse_texcoord(rest).unwrap_or_else(|| {
                    note(&mut self.bad_texcoords, line_number);
                    DVec2::NAN
                });
                if number == self.texcoords.capacity() {
                    reserve(&mut self.texcoords, number, self.lines.path())?;
                }
                self.texcoords.push(texcoord);
                self.ready.extend_from_slice(b"vt ");
                push_number(&mut self.ready, (number / NUMBERS_AT_ONCE) as u64);
                self.ready.push(b' ');
                push_number(&mut self.ready, (number % NUMBERS_AT_ONCE) as u64);
                self.ready.push(b'\n');
            }
            b"vn" => {
                if self.defined.normals == 0 {
                    let missing = format!("vn {MISSING:e} {MISSING:e} {MISSING:e}\n");
                    begin_list(&mut self.ready, self.group, self.faces_in_group, &missing);
                }
                self.defined.normals += 1;
                if words(rest).take(3).filter_map(finite).filter(|v| v.abs() <= MAX_COORDINATE).count() == 3 {
                    push_line(&mut self.ready, b"vn ", rest);
                } else {
                    note(&mut self.bad_normals, line_number);
                    self.ready.extend_from_slice(format!("vn {MISSING:e} {MISSING:e} {MISSING:e}\n").as_bytes());
                }
            }
            b"f" => {
                let before = self.ready.len();
                let mut bad_indices = 0;
                match push_face(&mut self.ready, rest, &self.defined, &mut bad_indices) {
                    Ok(corners) if corners > self.options.max_face_corners => {
                        return Err(Error::LimitExceeded {
                            what: format!("{}:{line_number}: a face", self.lines.path().display()),
                            limit: "corners of a face".into(),
                            wanted: format!("{corners} corners"),
                            allowed: format!("{}", self.options.max_face_corners),
                            remedies: &[Remedy::TriangulatedFaces],
                        });
                    }
                    Ok(corners) if corners >= 3 => {
                        self.faces_in_group += 1;
                        self.faces += 1;
                        self.group_has_faces[self.group] = true;
                        if bad_indices > 0 {
                            note(&mut self.bad_indices, line_number);
                            self.bad_indices.0 += bad_indices - 1;
                        }
                    }
                    Ok(_) => {
                        self.ready.truncate(before);
                        note(&mut self.small_faces, line_number);
                    }
                    Err(message) => return Err(syntax(self.lines.path(), line_number, message)),
                }
            }
            b"l" | b"p" => note(&mut self.lines_and_points, line_number),
            b"o" | b"g" => {
                let name = name_text(rest);
                self.open_group(name, line_number);
            }
            b"usemtl" => {
                let name = name_text(rest);
                let (id, new) = self.materials.number(name, line_number);
                if new {
                    self.ready.extend_from_slice(format!("mtllib {id}\n").as_bytes());
                }
                self.ready.extend_from_slice(format!("usemtl {id}\n").as_bytes());
            }
            b"mtllib" => {
                let name = name_text(rest);
                self.libraries.push((name, line_number));
            }
            b"curv" | b"curv2" | b"surf" => note(&mut self.free_form, line_number),
            b"s" => match Smoothing::parse(rest) {
                Some(now) if self.smoothing.last().is_some_and(|&(_, before)| before == now) => {}
                Some(now) => self.smoothing.push((self.faces, now)),
                None => self.unused.note(written, line_number),
            },
            // ZBrush's vertex colours are a comment.
            b"#mrgb" => self.unused.note(written, line_number),
            b"" | [b'#', ..] => {}
            // Render attributes and anything unknown: as any OBJ reader, pass over it, but not without a word.
            _ => self.unused.note(written, line_number),
        }
        let names = self.groups.names.len().max(self.materials.names.len()).max(self.libraries.len());
        if names > self.options.max_names {
            return Err(too_many(self.lines.path(), names, "names", self.options.max_names));
        }
        Ok(Step::More)
    }

    /// Starts a group (or goes on with one that was left).
    fn open_group(&mut self, name: String, line: usize) {
        let (id, new) = self.groups.number(name, line);
        if new {
            self.group_has_faces.push(false);
            self.group_reopened.push(false);
        } else if id != self.group && self.group_has_faces[id] {
            let name = &self.groups.names[id].0;
            if !name.is_empty() && !std::mem::replace(&mut self.group_reopened[id], true) {
                self.reopened_groups.push(name.clone());
            }
        }
        self.group = id;
        self.faces_in_group = 0;
        self.ready.extend_from_slice(format!("g {id}\n").as_bytes());
    }

    /// Fills `ready` with the next lines.
    fn refill(&mut self) -> Result<()> {
        self.ready.drain(..self.at);
        self.at = 0;
        self.monitor.check()?;
        while self.ready.len() < READY_BYTES {
            if let Step::End = self.step()? {
                break;
            }
        }
        self.monitor.tell(self.lines.fraction_read());
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        let path = self.lines.path().display();
        let mut all = Vec::new();
        let mut tell = |(count, line): (u64, usize), what: &str| {
            if count > 0 {
                all.push(format!("{path}:{line}: {count} {what} left out (first here)"));
            }
        };
        tell(self.lines_and_points, "line and point elements");
        tell(self.small_faces, "faces with fewer than three corners");
        tell(self.free_form, "free-form curves and surfaces");
        let mut mend = |(count, line): (u64, usize), what: &str| {
            if count > 0 {
                all.push(format!("{path}:{line}: {count} {what} (first here)"));
            }
        };
        mend(self.bad_texcoords, "texture coordinates (`vt`) are not finite numbers; taken as missing");
        mend(self.bad_normals, "normals (`vn`) are not three finite numbers; computed instead");
        mend(self.bad_indices, "indices of faces name a `vt` or `vn` that does not exist; taken as missing");
        all
    }
}

impl Read for Feed<'_> {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let n = self.fill_buf()?.read(buf)?;
        self.consume(n);
        Ok(n)
    }
}

impl BufRead for Feed<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at == self.ready.len()
            && let Err(e) = self.refill()
        {
            self.error = Some(e);
            return Err(io::Error::other("see the error that was kept"));
        }
        Ok(&self.ready[self.at..])
    }

    fn consume(&mut self, amount: usize) {
        self.at += amount;
    }
}

fn syntax(path: &Path, line: usize, message: String) -> Error {
    Error::Syntax { path: path.to_path_buf(), line, message }
}

fn note(counter: &mut (u64, usize), line: usize) {
    if counter.0 == 0 {
        counter.1 = line;
    }
    counter.0 += 1;
}

/// The part of `line` that holds its first `n` words.
fn first_words(line: &[u8], n: usize) -> &[u8] {
    let mut end = 0;
    for _ in 0..n {
        end += line[end..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        end += line[end..].iter().take_while(|b| !b.is_ascii_whitespace()).count();
    }
    &line[..end]
}

fn push_line(out: &mut Vec<u8>, key: &[u8], rest: &[u8]) {
    out.extend_from_slice(key);
    out.extend_from_slice(rest);
    out.push(b'\n');
}

/// The number in a word, if it is finite in single precision.
fn finite(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok().filter(|v: &f32| v.is_finite())
}

/// Texture coordinates: one or two finite numbers.
fn parse_texcoord(text: &[u8]) -> Option<DVec2> {
    let mut words = words(text);
    let number = |word: &[u8]| {
        let single = finite(word)?;
        if f64::from(single.abs()) < FAR_TEXCOORD {
            return Some(f64::from(single));
        }
        let double: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
        (double.abs() <= f64::from(MAX_COORDINATE)).then_some(double)
    };
    let s = number(words.next()?)?;
    Some(DVec2::new(s, words.next().map_or(Some(0.0), number)?))
}

/// Most texture coordinates: their numbers are written as two floats that are exact up to 2^24.
const MOST_TEXCOORDS: usize = u32::MAX as usize / 4;

fn too_many(path: &Path, count: usize, what: &str, most: usize) -> Error {
    Error::LimitExceeded {
        what: path.display().to_string(),
        limit: what.into(),
        wanted: format!("{count} {what} or more"),
        allowed: most.to_string(),
        remedies: &[Remedy::SmallerScene],
    }
}

/// Writes the first entry of a list of texture coordinates or normals, which stands for "missing". Faces of the same group
/// that came before must not meet that list, so they are closed first.
fn begin_list(out: &mut Vec<u8>, group: usize, faces_in_group: u64, entry: &str) {
    if faces_in_group > 0 {
        out.extend_from_slice(format!("g {group}\n").as_bytes());
    }
    out.extend_from_slice(entry.as_bytes());
}

/// Writes a face in plain OBJ; the number of its corners, or what is wrong with it. Counts the indices that are taken as
/// missing.
fn push_face(
    out: &mut Vec<u8>,
    rest: &[u8],
    defined: &Defined,
    bad_indices: &mut u64,
) -> std::result::Result<usize, String> {
    out.push(b'f');
    let mut corners = 0;
    for word in words(rest) {
        out.push(b' ');
        push_corner(out, word, defined, bad_indices)
            .map_err(|why| format!("corner `{}`: {why}", String::from_utf8_lossy(&word[..word.len().min(60)])))?;
        corners += 1;
    }
    out.push(b'\n');
    Ok(corners)
}

fn push_corner(
    out: &mut Vec<u8>,
    word: &[u8],
    defined: &Defined,
    bad_indices: &mut u64,
) -> std::result::Result<(), String> {
    let mut parts = word.split(|&b| b == b'/');
    let position = index(parts.next().unwrap_or_default(), defined.positions, "vertices (`v`)")?;
    // Vertices have no fallback; these do.
    let mut attribute = |count| {
        index(parts.next().unwrap_or_default(), count, "").unwrap_or_else(|_| {
            *bad_indices += 1;
            None
        })
    };
    let (texcoord, normal) = (attribute(defined.texcoords), attribute(defined.normals));
    if parts.next().is_some() {
        return Err("more than three indices; v, v/vt, v//vn or v/vt/vn are right".into());
    }
    let Some(position) = position else { return Err("no vertex index; v, v/vt, v//vn or v/vt/vn are right".into()) };
    push_number(out, position);
    // The entry MISSING comes first where a list has begun.
    let (has_texcoords, has_normals) = (defined.texcoords > 0, defined.normals > 0);
    if has_texcoords {
        out.push(b'/');
        push_number(out, texcoord.map_or(1, |t| t + 1));
    } else if has_normals {
        out.push(b'/');
    }
    if has_normals {
        out.push(b'/');
        push_number(out, normal.map_or(1, |n| n + 1));
    }
    Ok(())
}

/// An index from 1, made from one that may count backwards. `None`: left empty.
fn index(text: &[u8], count: u64, what: &str) -> std::result::Result<Option<u64>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    let (negative, digits) = match text[0] {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return Err("an index must be a whole number".into());
    }
    // Saturates: any such number is out of range.
    let value = digits.iter().fold(0u64, |v, d| v.saturating_mul(10).saturating_add(u64::from(d - b'0')));
    if value == 0 {
        return Err("index 0; OBJ files count from 1".into());
    }
    if value > count {
        return Err(format!("index out of range: {count} {what} are defined above this line"));
    }
    Ok(Some(if negative { count - value + 1 } else { value }))
}

fn push_number(out: &mut Vec<u8>, mut value: u64) {
    let mut digits = [0u8; 20];
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[at..]);
}
