// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words for a choice of device: `auto`, `cpu`, `twin`, `opencl`, `opencl:N`.

use std::str::FromStr;

use crate::device::open::DeviceChoice;
use crate::error::{Error, Result, Setting};

impl std::fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            DeviceChoice::Auto => f.write_str("auto"),
            DeviceChoice::Cpu => f.write_str("cpu"),
            DeviceChoice::Twin => f.write_str("twin"),
            DeviceChoice::OpenCl(None) => f.write_str("opencl"),
            DeviceChoice::OpenCl(Some(index)) => write!(f, "opencl:{index}"),
        }
    }
}

impl FromStr for DeviceChoice {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let choice = match text.split_once(':') {
            None if text == "auto" => Some(DeviceChoice::Auto),
            None if text == "cpu" => Some(DeviceChoice::Cpu),
            None if text == "twin" => Some(DeviceChoice::Twin),
            None if text == "opencl" => Some(DeviceChoice::OpenCl(None)),
            Some(("opencl", index)) => index.parse().ok().map(|index| DeviceChoice::OpenCl(Some(index))),
            _ => None,
        };
        choice.ok_or_else(|| Error::option(Setting::Device, text, "auto, cpu, twin, opencl or opencl:N"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_go_there_and_back() {
        for text in ["auto", "cpu", "twin", "opencl", "opencl:3"] {
            assert_eq!(text.parse::<DeviceChoice>().unwrap().to_string(), text);
        }
        for text in ["gpu", "cpu:1", "opencl:", "opencl:x", "auto:"] {
            assert!(text.parse::<DeviceChoice>().is_err(), "{text}");
        }
    }
}
