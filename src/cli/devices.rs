// SPDX-License-Identifier: MIT OR Apache-2.0
//! `rarefy devices`.

use rarefy::Result;
use rarefy::opencl::{Limits, discover};

use super::args::{DevicesArgs, profile};
use super::output::{say, write_json};

/// Lists devices with their limits, beside those under a profile if one is asked for.
pub fn run(args: &DevicesArgs) -> Result<()> {
    let profile = profile(&args.profile)?;
    let discovery = discover();
    let json = args.json.as_deref();
    for (index, device) in discovery.devices.iter().enumerate() {
        say(json, &format!("opencl:{index}  {}", device.info.describe()));
        let own = Limits::new(&device.profile, None);
        let clamped = profile.as_ref().map(|p| Limits::new(&device.profile, Some(p)));
        if clamped.is_some() {
            say(json, &format!("    {:34} {:>16} {:>16}", "limit", "device", args.profile));
        }
        let rows = |limits: &Limits| limit_rows(limits);
        let clamped_rows = clamped.as_ref().map(rows);
        for (row, (name, value)) in rows(&own).into_iter().enumerate() {
            let beside = clamped_rows.as_ref().map_or(String::new(), |r| format!(" {:>16}", r[row].1));
            say(json, &format!("    {name:34} {value:>16}{beside}"));
        }
    }
    if discovery.devices.is_empty() {
        say(json, "no usable OpenCL device; pictures are drawn by the CPU twin (--device cpu)");
    }
    for skipped in &discovery.skipped {
        say(json, &format!("skipped: {skipped}"));
    }
    match json {
        Some(path) => write_json(path, &discovery.to_json()),
        None => Ok(()),
    }
}

fn limit_rows(limits: &Limits) -> Vec<(&'static str, String)> {
    vec![
        ("OpenCL version", format!("{}.{}", limits.version.0, limits.version.1)),
        ("global memory, bytes", limits.global_mem_bytes.to_string()),
        ("largest allocation, bytes", limits.max_mem_alloc_bytes.to_string()),
        ("local memory, bytes", limits.local_mem_bytes.to_string()),
        ("work-group, items", limits.max_work_group_size.to_string()),
        ("work-group with barriers, items", limits.barrier_work_group_size.to_string()),
        ("kernel arguments, bytes", limits.max_parameter_bytes.to_string()),
        ("constant buffer, bytes", limits.max_constant_buffer_bytes.to_string()),
        ("constant arguments", limits.max_constant_args.to_string()),
        ("compute units", limits.compute_units.to_string()),
    ]
}
