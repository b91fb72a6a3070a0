// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a report says of its run: program, commit, time, machine.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rarefy::internal::analysis::report::bench::About;
use rarefy::internal::device::executor::ExecutorInfo;

/// All that is known before anything is measured.
pub fn about(info: &ExecutorInfo, options: String, started: SystemTime) -> About {
    About {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: commit(),
        started: utc(started),
        machine: machine(),
        device: info.name.clone(),
        driver: info.version.clone(),
        backend: format!("{}, device profile: {}", info.backend, info.profile),
        options,
        ..About::default()
    }
}

/// What tells one build of the program from another: its file's length and time.
pub fn program() -> String {
    let metadata = std::env::current_exe().and_then(|path| path.metadata());
    match metadata.and_then(|m| Ok((m.len(), m.modified()?))) {
        Ok((length, time)) => format!("{length} bytes of {time:?}"),
        // Never the same: nothing is reused.
        Err(_) => format!("unknown at {:?}", SystemTime::now()),
    }
}

/// The commit of the checkout that the program was built in, as it is now.
fn commit() -> String {
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = |arguments: &[&str]| {
        let output = Command::new("git").arg("-C").arg(checkout).args(arguments).stderr(Stdio::null()).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(hash) = git(&["rev-parse", "HEAD"]).filter(|hash| !hash.is_empty()) else {
        return "not known: the program\u{2019}s checkout is not here".into();
    };
    let short: String = hash.chars().take(12).collect();
    let changed = git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|files| !files.is_empty());
    let committed = git(&["log", "-1", "--format=%ct"]).and_then(|seconds| seconds.parse::<u64>().ok());
    let built = std::env::current_exe().and_then(|path| path.metadata()).and_then(|metadata| metadata.modified());
    let is_older = match (committed, built) {
        (Some(committed), Ok(built)) => built < UNIX_EPOCH + Duration::from_secs(committed),
        _ => false,
    };
    match (changed, is_older) {
        (_, true) => format!("{short}, but the program was built before that commit"),
        (true, _) => format!("{short}, with changes that are not committed"),
        _ => short,
    }
}

/// Processor, cores and system.
fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let cpu = std::fs::read_to_string("/proc/cpuinfo").ok();
    let name = cpu.as_deref().and_then(|text| text.lines().find_map(|line| line.strip_prefix("model name")));
    let name = name.map_or(std::env::consts::ARCH, |rest| rest.trim_start_matches([' ', '\t', ':']));
    format!("{name}, {cores} hardware threads, {} ({})", std::env::consts::OS, std::env::consts::ARCH)
}

/// A time as year, month, day, hour and minute in UTC.
fn utc(time: SystemTime) -> String {
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (mut days, minutes) = (seconds / 86_400, seconds % 86_400 / 60);
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while days >= lengths[month] {
        days -= lengths[month];
        month += 1;
    }
    format!("{year}-{:02}-{:02} {:02}:{:02} UTC", month + 1, days + 1, minutes / 60, minutes % 60)
}

/// A duration as people say it.
pub fn duration(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..120 => format!("{seconds} s"),
        seconds => format!("{} min", (seconds + 30) / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_calendar() {
        let at = |seconds: u64| utc(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01 00:00 UTC");
        assert_eq!(at(951_782_400), "2000-02-29 00:00 UTC");
        assert_eq!(at(4_107_542_399), "2100-02-28 23:59 UTC");
        assert_eq!(at(4_107_542_400), "2100-03-01 00:00 UTC");
        assert_eq!(at(1_795_942_861), "2026-11-29 09:01 UTC");
        assert_eq!(duration(Duration::from_secs(119)), "119 s");
        assert_eq!(duration(Duration::from_secs(150)), "3 min");
    }

    #[test]
    fn something_is_known_of_the_program_and_the_machine() {
        assert!(program().contains("bytes of"), "{}", program());
        assert!(machine().contains("hardware threads"), "{}", machine());
        assert!(!commit().is_empty());
    }
}
