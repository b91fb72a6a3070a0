// SPDX-License-Identifier: MIT OR Apache-2.0
//! What may be asked of a device: its own answers, clamped by a profile, and the checks against them.

use crate::device::profiles::Profile;
use crate::error::Remedy;
use crate::{Error, Result};

/// What a limit's check gives as remedies.
type Remedies = &'static [Remedy];

/// The remedies where no setting makes a request smaller.
const OTHER_DEVICE: Remedies = &[Remedy::OtherDevice, Remedy::Cpu];
const SMALLER: Remedies = &[Remedy::SmallerPicture, Remedy::SmallerScene];
const SMALLER_WORK_GROUP: Remedies = &[Remedy::SmallerWorkGroup];
const BUFFERS: Remedies = &[Remedy::BufferMemory];

/// The limits that the context enforces. A number without a known limit is the largest of its type.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// `CL_DEVICE_GLOBAL_MEM_SIZE`: all buffers together, in bytes.
    pub global_mem_bytes: u64,
    /// `CL_DEVICE_MAX_MEM_ALLOC_SIZE`: one buffer, in bytes.
    pub max_mem_alloc_bytes: u64,
    /// `CL_DEVICE_MAX_WORK_GROUP_SIZE`: work-items of a work-group.
    pub max_work_group_size: u64,
    /// A profile's `CL_KERNEL_WORK_GROUP_SIZE`: work-items of a work-group of a kernel with barriers.
    pub barrier_work_group_size: u64,
    /// `CL_DEVICE_MAX_WORK_ITEM_SIZES`: work-items along each side of a work-group.
    pub max_work_item_sizes: [u64; 3],
    /// `CL_DEVICE_LOCAL_MEM_SIZE`, in bytes.
    pub local_mem_bytes: u64,
    /// `CL_DEVICE_MAX_PARAMETER_SIZE`: all arguments of a kernel together, in bytes.
    pub max_parameter_bytes: u64,
    /// `CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE`: one `constant` argument, in bytes.
    pub max_constant_buffer_bytes: u64,
    /// `CL_DEVICE_MAX_CONSTANT_ARGS`: number of `constant` arguments of a kernel.
    pub max_constant_args: u64,
    /// `CL_DEVICE_MEM_BASE_ADDR_ALIGN`: alignment of a sub-buffer's start, in **bits**.
    pub mem_base_addr_align_bits: u64,
    /// `CL_DEVICE_ADDRESS_BITS`: 32 or 64.
    pub address_bits: u64,
    /// `CL_DEVICE_IMAGE_SUPPORT`.
    pub image_support: bool,
    /// `CL_DEVICE_IMAGE2D_MAX_WIDTH` and `..._HEIGHT`, in pixels.
    pub image2d: [u64; 2],
    /// `CL_DEVICE_IMAGE_MAX_ARRAY_SIZE`, in layers.
    pub image_layers: u64,
    /// `CL_DEVICE_IMAGE_MAX_BUFFER_SIZE`, in texels.
    pub image_buffer_texels: u64,
    /// `CL_DEVICE_MAX_READ_IMAGE_ARGS`.
    pub read_image_args: u64,
    /// `CL_DEVICE_MAX_WRITE_IMAGE_ARGS`.
    pub write_image_args: u64,
    /// The extensions that may be switched on.
    pub extensions: Vec<String>,
    /// The OpenCL version: major, minor.
    pub version: (u32, u32),
    /// The longest that one enqueue should take, in milliseconds; `None`: as long as it likes.
    pub slice_ms: Option<f64>,
    /// After this time the system kills an enqueue, in milliseconds.
    pub watchdog_ms: Option<u64>,
    /// `CL_DEVICE_MAX_COMPUTE_UNITS`.
    pub compute_units: u64,
    /// Whether division and square root can be rounded correctly, if the build asks for it.
    pub correctly_rounded_divide_sqrt: bool,
    /// Which limits a profile set below the device's own: key of the query, name of the profile.
    set_by: Vec<(&'static str, String)>,
}

/// The major and minor version in an answer such as `OpenCL 1.2 Adreno(TM) 420` or `OpenCL C 1.2`.
pub(super) fn parse_version(text: &str) -> Option<(u32, u32)> {
    let text = text.strip_prefix("OpenCL ")?;
    let text = text.strip_prefix("C ").unwrap_or(text);
    let (major, rest) = text.split_once('.')?;
    let minor: String = rest.chars().take_while(char::is_ascii_digit).collect();
    Some((major.parse().ok()?, minor.parse().ok()?))
}

impl Limits {
    /// The limits of a device, clamped by a profile if there is one.
    pub fn new(device: &Profile, profile: Option<&Profile>) -> Self {
        let mut limits = Limits {
            global_mem_bytes: u64::MAX,
            max_mem_alloc_bytes: u64::MAX,
            max_work_group_size: u64::MAX,
            barrier_work_group_size: u64::MAX,
            max_work_item_sizes: [u64::MAX; 3],
            local_mem_bytes: u64::MAX,
            max_parameter_bytes: u64::MAX,
            max_constant_buffer_bytes: u64::MAX,
            max_constant_args: u64::MAX,
            mem_base_addr_align_bits: 8,
            address_bits: 64,
            image_support: true,
            image2d: [u64::MAX; 2],
            image_layers: u64::MAX,
            image_buffer_texels: u64::MAX,
            read_image_args: u64::MAX,
            write_image_args: u64::MAX,
            extensions: device.words("cl_device_extensions").unwrap_or_default(),
            version: (u32::MAX, 0),
            slice_ms: None,
            watchdog_ms: None,
            compute_units: u64::MAX,
            correctly_rounded_divide_sqrt: device
                .words("cl_device_single_fp_config")
                .is_some_and(|flags| flags.iter().any(|flag| flag == "CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT")),
            set_by: Vec::new(),
        };
        limits.clamp(device, None);
        if let Some(profile) = profile {
            limits.clamp(profile, Some(profile.name()));
        }
        limits
    }

    fn clamp(&mut self, source: &Profile, profile: Option<&str>) {
        let mut set_by = std::mem::take(&mut self.set_by);
        let mut note = |key: &'static str, lowered: bool| {
            if let (true, Some(name)) = (lowered, profile) {
                set_by.push((key, name.to_string()));
            }
        };
        let mut least = |value: &mut u64, key: &'static str| {
            if let Some(limit) = source.count(key) {
                note(key, limit < *value);
                *value = limit.min(*value);
            }
        };
        least(&mut self.global_mem_bytes, "cl_device_global_mem_size");
        least(&mut self.max_mem_alloc_bytes, "cl_device_max_mem_alloc_size");
        least(&mut self.max_work_group_size, "cl_device_max_work_group_size");
        least(&mut self.barrier_work_group_size, "cl_kernel_work_group_size");
        least(&mut self.local_mem_bytes, "cl_device_local_mem_size");
        least(&mut self.max_parameter_bytes, "cl_device_max_parameter_size");
        least(&mut self.max_constant_buffer_bytes, "cl_device_max_constant_buffer_size");
        least(&mut self.max_constant_args, "cl_device_max_constant_args");
        least(&mut self.address_bits, "cl_device_address_bits");
        least(&mut self.image2d[0], "cl_device_image2d_max_width");
        least(&mut self.image2d[1], "cl_device_image2d_max_height");
        least(&mut self.image_layers, "cl_device_image_max_array_size");
        least(&mut self.image_buffer_texels, "cl_device_image_max_buffer_size");
        least(&mut self.read_image_args, "cl_device_max_read_image_args");
        least(&mut self.write_image_args, "cl_device_max_write_image_args");
        least(&mut self.compute_units, "cl_device_max_compute_units");
        if let Some(sizes) = source.sizes("cl_device_max_work_item_sizes") {
            for (ours, theirs) in self.max_work_item_sizes.iter_mut().zip(sizes) {
                note("cl_device_max_work_item_sizes", theirs < *ours);
                *ours = theirs.min(*ours);
            }
        }
        if let Some(bits) = source.count("cl_device_mem_base_addr_align") {
            note("cl_device_mem_base_addr_align", bits > self.mem_base_addr_align_bits);
            self.mem_base_addr_align_bits = bits.max(self.mem_base_addr_align_bits);
        }
        if source.flag("cl_device_image_support") == Some(false) {
            note("cl_device_image_support", self.image_support);
            self.image_support = false;
        }
        if let Some(version) = source.text("cl_device_version").and_then(parse_version) {
            note("cl_device_version", version < self.version);
            self.version = version.min(self.version);
        }
        if let (Some(allowed), true) = (source.words("cl_device_extensions"), profile.is_some()) {
            let before = self.extensions.len();
            self.extensions.retain(|name| allowed.contains(name));
            note("cl_device_extensions", self.extensions.len() < before);
        }
        self.slice_ms = source.choices().slice_ms().or(self.slice_ms);
        self.watchdog_ms = source.hardware("gpu_batch_timeout_ms").or(self.watchdog_ms);
        self.set_by = set_by;
    }

    /// The name of a limit for a message: the query, and the profile if that set it.
    fn name(&self, key: &'static str) -> String {
        let query = key.to_ascii_uppercase();
        match self.set_by.iter().rev().find(|(known, _)| *known == key) {
            Some((_, profile)) => format!("{query} of profile {profile}"),
            None => query,
        }
    }

    /// An error if `wanted` is above `allowed`.
    fn most(
        &self,
        what: &str,
        key: &'static str,
        wanted: u64,
        allowed: u64,
        unit: &str,
        remedies: Remedies,
    ) -> Result<()> {
        if wanted <= allowed {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: what.to_string(),
            limit: self.name(key),
            wanted: format!("{wanted}{unit}"),
            allowed: format!("{allowed}{unit}"),
            remedies,
        })
    }

    /// Checks the size of one buffer.
    pub fn check_alloc(&self, what: &str, bytes: u64) -> Result<()> {
        let remedies = SMALLER;
        self.most(what, "cl_device_max_mem_alloc_size", bytes, self.max_mem_alloc_bytes, " bytes", remedies)
    }

    /// Checks all buffers together: `used` bytes so far and `bytes` more.
    pub fn check_total(&self, what: &str, used: u64, bytes: u64) -> Result<()> {
        let what = format!("{what}, with {used} bytes in use");
        let total = used.saturating_add(bytes);
        let remedies = SMALLER;
        self.most(&what, "cl_device_global_mem_size", total, self.global_mem_bytes, " bytes", remedies)
    }

    /// Checks the shape of a work-group for a kernel that runs at most `kernel_cap` work-items.
    pub fn check_work_group(&self, what: &str, local: [usize; 2], kernel_cap: u64, barrier: bool) -> Result<()> {
        let sides = local.map(|side| side as u64);
        let total = sides[0].saturating_mul(sides[1]);
        let remedies = SMALLER_WORK_GROUP;
        let unit = " work-items";
        for (axis, side) in sides.into_iter().enumerate() {
            let what = format!("side {axis} of the work-group of {what}");
            let allowed = self.max_work_item_sizes[axis];
            self.most(&what, "cl_device_max_work_item_sizes", side, allowed, unit, remedies)?;
        }
        let what = format!("the {}x{} work-group of {what}", local[0], local[1]);
        self.most(&what, "cl_device_max_work_group_size", total, self.max_work_group_size, unit, remedies)?;
        if barrier {
            let allowed = self.barrier_work_group_size;
            let what = format!("{what}, which has barriers,");
            self.most(&what, "cl_kernel_work_group_size", total, allowed, unit, remedies)?;
        }
        if total > kernel_cap {
            return Err(Error::LimitExceeded {
                what,
                limit: "CL_KERNEL_WORK_GROUP_SIZE".into(),
                wanted: format!("{total}{unit}"),
                allowed: format!("{kernel_cap}{unit}"),
                remedies,
            });
        }
        Ok(())
    }

    /// The largest work-group within all limits that one gets from `wanted` by halving its longer side.
    pub fn fit_work_group(&self, wanted: [usize; 2], kernel_cap: u64, barrier: bool) -> [usize; 2] {
        let mut local = wanted.map(|side| side.max(1));
        while local != [1, 1] && self.check_work_group("", local, kernel_cap, barrier).is_err() {
            let too_long = (0..2).find(|&axis| local[axis] as u64 > self.max_work_item_sizes[axis]);
            let axis = too_long.unwrap_or(if local[0] >= local[1] { 0 } else { 1 });
            local[axis] = (local[axis] / 2).max(1);
        }
        local
    }

    /// Checks the local memory of a work-group, in bytes.
    pub fn check_local_memory(&self, what: &str, bytes: u64) -> Result<()> {
        let what = format!("the local memory of {what}");
        self.most(&what, "cl_device_local_mem_size", bytes, self.local_mem_bytes, " bytes", SMALLER_WORK_GROUP)
    }

    /// Checks the bytes of all arguments of a kernel.
    pub fn check_parameters(&self, what: &str, bytes: u64) -> Result<()> {
        let what = format!("the argument list of {what}");
        self.most(&what, "cl_device_max_parameter_size", bytes, self.max_parameter_bytes, " bytes", OTHER_DEVICE)
    }

    /// Checks the sizes of a kernel's `constant` arguments, in bytes.
    pub fn check_constants(&self, what: &str, sizes: &[u64]) -> Result<()> {
        let count = sizes.len() as u64;
        let what_count = format!("the number of constant arguments of {what}");
        self.most(&what_count, "cl_device_max_constant_args", count, self.max_constant_args, "", OTHER_DEVICE)?;
        let what = format!("a constant argument of {what}");
        sizes.iter().try_for_each(|&bytes| {
            let allowed = self.max_constant_buffer_bytes;
            let remedies = &[Remedy::FewerLights, Remedy::OtherDevice, Remedy::Cpu];
            self.most(&what, "cl_device_max_constant_buffer_size", bytes, allowed, " bytes", remedies)
        })
    }

    /// Checks the number of images that a kernel reads and writes.
    pub fn check_image_args(&self, what: &str, read: u64, written: u64) -> Result<()> {
        let read_what = format!("the number of images read by {what}");
        self.most(&read_what, "cl_device_max_read_image_args", read, self.read_image_args, "", BUFFERS)?;
        let what = format!("the number of images written by {what}");
        self.most(&what, "cl_device_max_write_image_args", written, self.write_image_args, "", BUFFERS)
    }

    /// Checks a 2D image, of `layers` layers if it is an array (else 1).
    pub fn check_image2d(&self, what: &str, width: u64, height: u64, layers: u64) -> Result<()> {
        self.check_images(what)?;
        let remedies = BUFFERS;
        let pixels = " pixels";
        let side = format!("the width of {what}");
        self.most(&side, "cl_device_image2d_max_width", width, self.image2d[0], pixels, remedies)?;
        let side = format!("the height of {what}");
        self.most(&side, "cl_device_image2d_max_height", height, self.image2d[1], pixels, remedies)?;
        self.most(what, "cl_device_image_max_array_size", layers, self.image_layers.max(1), " layers", remedies)
    }

    /// Checks a 1D image on top of a buffer.
    pub fn check_image_buffer(&self, what: &str, texels: u64) -> Result<()> {
        self.check_images(what)?;
        let remedies = BUFFERS;
        let allowed = self.image_buffer_texels;
        self.most(what, "cl_device_image_max_buffer_size", texels, allowed, " texels", remedies)
    }

    fn check_images(&self, what: &str) -> Result<()> {
        let wanted = u64::from(!self.image_support);
        let remedies = BUFFERS;
        self.most(what, "cl_device_image_support", wanted, 0, " image", remedies)
    }

    /// Checks that a sub-buffer may start at `offset` bytes.
    pub fn check_sub_buffer(&self, what: &str, offset: u64) -> Result<()> {
        let align = (self.mem_base_addr_align_bits / 8).max(1);
        if offset.is_multiple_of(align) {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: format!("a sub-buffer of {what}"),
            limit: self.name("cl_device_mem_base_addr_align"),
            wanted: format!("a start at byte {offset}"),
            allowed: format!("multiples of {align} bytes"),
            remedies: &[Remedy::RoundedStart],
        })
    }

    /// Checks that an extension may be switched on.
    pub fn check_extension(&self, what: &str, extension: &str) -> Result<()> {
        if self.extensions.iter().any(|name| name == extension) {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: what.to_string(),
            limit: self.name("cl_device_extensions"),
            wanted: extension.to_string(),
            allowed: if self.extensions.is_empty() { "no extension".into() } else { self.extensions.join(" ") },
            remedies: OTHER_DEVICE,
        })
    }

    /// Checks that a feature of an OpenCL version may be used.
    pub fn check_version(&self, what: &str, wanted: (u32, u32)) -> Result<()> {
        if wanted <= self.version {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: what.to_string(),
            limit: self.name("cl_device_version"),
            wanted: format!("OpenCL {}.{}", wanted.0, wanted.1),
            allowed: format!("OpenCL {}.{}", self.version.0, self.version.1),
            remedies: OTHER_DEVICE,
        })
    }

    /// Checks the size of a launch along one side against what the device can count to.
    pub fn check_global(&self, what: &str, items: u64) -> Result<()> {
        // This program's own `size_t` counts as well.
        let allowed = if self.address_bits >= 64 { usize::MAX as u64 } else { u64::from(u32::MAX) };
        self.most(
            &format!("a launch of {what}"),
            "cl_device_address_bits",
            items,
            allowed,
            " work-items",
            &[Remedy::SmallerPicture],
        )
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn phone() -> Limits {
        let device = Profile::named("adreno-530").unwrap();
        Limits::new(&device, Some(&Profile::named("adreno-420").unwrap()))
    }

    #[test]
    fn versions_are_parsed() {
        assert_eq!(parse_version("OpenCL 1.2 Adreno(TM) 420"), Some((1, 2)));
        assert_eq!(parse_version("OpenCL C 3.0"), Some((3, 0)));
        assert_eq!(parse_version("OpenCL 1.10x"), Some((1, 10)));
        assert_eq!(parse_version("OpenGL 4.5"), None);
        assert_eq!(parse_version(""), None);
    }

    #[test]
    fn a_profile_only_lowers() {
        let limits = phone();
        assert_eq!(limits.version, (1, 2));
        assert_eq!(limits.address_bits, 32);
        assert_eq!(limits.max_mem_alloc_bytes, 256 << 20);
        let floor = Profile::named("embedded-floor").unwrap();
        let clamped = Limits::new(&floor, Some(&Profile::named("adreno-420").unwrap()));
        assert_eq!(clamped.max_work_group_size, 64);
        assert!(!clamped.extensions.contains(&"cl_khr_fp16".to_string()));
    }

    #[test]
    fn a_message_names_limit_wanted_and_allowed() {
        let limits = phone();
        let message = limits.check_alloc("buffer `nodes`", 300 << 20).unwrap_err().to_string();
        assert_eq!(
            message,
            "buffer `nodes` needs 314572800 bytes, the limit `CL_DEVICE_MAX_MEM_ALLOC_SIZE of profile adreno-420` \
             allows 268435456 bytes (use a smaller picture or a smaller scene)"
        );
        assert!(limits.check_alloc("b", 256 << 20).is_ok());
        assert!(limits.check_total("b", 1 << 30, 1).is_err());
        assert!(limits.check_total("b", u64::MAX, u64::MAX).is_err());
    }

    #[test]
    fn limits_of_objects_that_only_phones_have_are_checked() {
        let limits = phone();
        assert!(limits.check_image2d("i", 16384, 16384, 1).is_ok());
        for error in [
            limits.check_image2d("i", 16385, 1, 1),
            limits.check_image2d("i", 1, 16385, 1),
            limits.check_image2d("i", 1, 1, 2049),
            limits.check_image_buffer("i", 65537),
            limits.check_image_args("k", 129, 0),
            limits.check_image_args("k", 0, 9),
            limits.check_sub_buffer("s", 64),
            limits.check_extension("p", "cl_khr_fp64"),
            limits.check_version("p", (2, 0)),
            limits.check_global("k", 1 << 32),
        ] {
            assert!(matches!(error, Err(Error::LimitExceeded { .. })), "{error:?}");
        }
        assert!(limits.check_sub_buffer("s", 128).is_ok());
        assert!(limits.check_extension("p", "cl_khr_fp16").is_ok());
        assert!(limits.check_image_buffer("i", 65536).is_ok());
    }

    #[test]
    fn a_work_group_is_made_to_fit() {
        let limits = phone();
        assert_eq!(limits.fit_work_group([8, 8], 1024, false), [8, 8]);
        assert_eq!(limits.fit_work_group([8, 8], 32, false), [4, 8]);
        assert_eq!(limits.fit_work_group([64, 16], 1024, true), [16, 16]);
        assert_eq!(limits.fit_work_group([4096, 1], 4096, false), [1024, 1]);
        assert_eq!(limits.fit_work_group([8, 8], 0, false), [1, 1]);
        assert!(limits.check_work_group("k", [64, 16], 1024, false).is_ok());
        assert!(limits.check_work_group("k", [64, 16], 1024, true).is_err());
        assert!(limits.check_work_group("k", [64, 16], 512, false).is_err());
    }
}
