// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy devices`.

use std::path::Path;

use rarefy::Result;
use rarefy::internal::device::opencl::executor::{scan_group, work_group};
use rarefy::internal::device::opencl::{DeviceFound, Limits, Profile, discover, library};
use rarefy::internal::device::profiles::MemoryPath;
use rarefy::internal::device::stage::Stage;
use rarefy::internal::render::renderer::DEFAULT_BUDGET_BYTES;

use super::args::{DevicesArgs, profile};
use super::output::{say, write_json};
use super::outputs::Outputs;

/// What the kernels can do today; a profile may already choose more.
const MEMORY_PATHS: [MemoryPath; 1] = [MemoryPath::Buffers];
const LANES: [u32; 1] = [1];

/// Lists devices with their limits and what would be chosen, beside the same under a profile.
pub fn run(args: &DevicesArgs) -> Result<()> {
    let profile = profile(&args.profile)?;
    Outputs::of_inputs([Path::new(&args.profile)]).json(args.json.as_deref())?;
    let discovery = discover();
    let json = args.json.as_deref();
    let title = args.profile.to_string_lossy();
    for (index, device) in discovery.devices.iter().enumerate() {
        say(json, &format!("opencl:{index}  {}", device.info.describe()));
        let under: Vec<Option<&Profile>> = std::iter::once(None).chain(profile.as_ref().map(Some)).collect();
        let titles: Vec<&str> = ["device", &title].into_iter().take(under.len()).collect();
        table(&titles, "limit", &under.iter().map(|p| limit_rows(&device.limits(*p))).collect::<Vec<_>>())
            .iter()
            .for_each(|line| say(json, line));
        say(json, "");
        table(&titles, "choice", &under.iter().map(|p| choice_rows(device, *p)).collect::<Vec<_>>())
            .iter()
            .for_each(|line| say(json, line));
        if under.iter().any(|profile| choice_rows(device, *profile).iter().any(|(_, value)| value.ends_with('*'))) {
            say(json, &format!("    * not there yet: today {}, {} lane", MEMORY_PATHS[0].name(), LANES[0]));
        }
        say(json, "");
    }
    if discovery.devices.is_empty() {
        say(json, "no usable OpenCL device; pictures are drawn by the CPU (--device cpu)");
    }
    let search = library::find(None);
    if let Some(accepted) = &search.accepted {
        say(json, &format!("library: {accepted}"));
        search.reasons().iter().for_each(|reason| say(json, &format!("library not used: {reason}")));
    }
    for skipped in &discovery.skipped {
        say(json, &format!("skipped: {skipped}"));
    }
    match json {
        Some(path) => write_json(path, &discovery.dump()),
        None => Ok(()),
    }
}

type Rows = Vec<(String, String)>;

/// The lines of a table: a heading, then each row's name and its value in each column.
fn table(titles: &[&str], what: &str, columns: &[Rows]) -> Vec<String> {
    let line = |name: &str, values: &[&str]| {
        let values: String = values.iter().map(|value| format!(" {value:>24}")).collect();
        format!("    {name:34}{values}")
    };
    let Some(first) = columns.first() else { return Vec::new() };
    let rows = first
        .iter()
        .enumerate()
        .map(|(row, (name, _))| line(name, &columns.iter().map(|column| column[row].1.as_str()).collect::<Vec<_>>()));
    std::iter::once(line(what, titles)).chain(rows).collect()
}

/// A limit in its unit; the largest number stands for none.
fn number(limit: u64) -> String {
    if limit == u64::MAX { "no limit".into() } else { limit.to_string() }
}

fn limit_rows(limits: &Limits) -> Rows {
    let sides = limits.max_work_item_sizes;
    let images = match limits.image_support {
        true => format!("{} x {}", number(limits.image2d[0]), number(limits.image2d[1])),
        false => "no images".into(),
    };
    let rows = [
        ("OpenCL version", format!("{}.{}", limits.version.0, limits.version.1)),
        ("global memory, bytes", number(limits.global_mem_bytes)),
        ("largest allocation, bytes", number(limits.max_mem_alloc_bytes)),
        ("local memory, bytes", number(limits.local_mem_bytes)),
        ("work-group, items", number(limits.max_work_group_size)),
        ("work-group with barriers, items", number(limits.barrier_work_group_size)),
        ("sides of a work-group, items", format!("{} x {}", number(sides[0]), number(sides[1]))),
        ("kernel arguments, bytes", number(limits.max_parameter_bytes)),
        ("constant buffer, bytes", number(limits.max_constant_buffer_bytes)),
        ("constant arguments", number(limits.max_constant_args)),
        ("start of a sub-buffer, bytes", (limits.mem_base_addr_align_bits / 8).to_string()),
        ("address, bits", limits.address_bits.to_string()),
        ("2D image, pixels", images),
        ("extensions", limits.extensions.len().to_string()),
        ("compute units", number(limits.compute_units)),
        ("watchdog, ms", limits.watchdog_ms.map_or("none".into(), |ms| ms.to_string())),
    ];
    rows.map(|(name, value)| (name.to_string(), value)).into()
}

/// What would be chosen for `device` under `profile`, fitted to the limits. A kernel's own limit, which is known only
/// once it is built, may lower a work-group further.
fn choice_rows(device: &DeviceFound, profile: Option<&Profile>) -> Rows {
    let limits = device.limits(profile);
    let choices = device.choices(profile);
    let mut rows = Rows::new();
    for stage in Stage::ALL {
        let mut shapes: Vec<String> = Vec::new();
        for kernel in stage.kernels() {
            let Some(wanted) = work_group(choices, stage, kernel) else { continue };
            let [width, height] = limits.fit_work_group(wanted, u64::MAX, false);
            let shape = format!("{width}x{height}");
            if !shapes.contains(&shape) {
                shapes.push(shape);
            }
        }
        rows.push((format!("work-group of {}, items", stage.name()), shapes.join(",")));
    }
    let scan = scan_group(&limits);
    let path = choices.memory_path();
    let lanes = choices.lanes();
    rows.extend(
        [
            ("work-group of scans, items", format!("{scan}x1")),
            ("slice, ms", limits.slice_ms.map_or("whole launches".into(), |ms| ms.to_string())),
            ("memory path", marked(path.name(), MEMORY_PATHS.contains(&path))),
            ("traversal", choices.traversal().name().into()),
            ("lanes", marked(&lanes.to_string(), LANES.contains(&lanes))),
            ("memory budget, MiB", (DEFAULT_BUDGET_BYTES.min(limits.global_mem_bytes) >> 20).to_string()),
        ]
        .map(|(name, value)| (name.to_string(), value)),
    );
    rows
}

/// A choice that a profile makes but the kernels do not offer yet is marked.
fn marked(name: &str, known: bool) -> String {
    if known { name.to_string() } else { format!("{name}*") }
}
