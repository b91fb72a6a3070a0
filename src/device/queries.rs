// SPDX-License-Identifier: MIT OR Apache-2.0
//! The OpenCL queries that a profile holds: one table for asking a device, for reading a profile and for naming limits.

use opencl3::device::*;

/// What kind of value a query has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A text.
    Text,
    /// A whole number from 0.
    Count,
    /// A whole number from 1; a device that answers 0 is taken as not knowing.
    Size,
    /// Three sizes.
    Sizes3,
    /// Yes or no.
    Flag,
    /// Names separated by spaces (extensions); in JSON a list or such a text.
    Words,
    /// A set of flags by name; in JSON a list of names, or 0 for none.
    Bits(&'static [(&'static str, u64)]),
    /// One of several named numbers.
    Choice(&'static [(&'static str, u64)]),
}

/// One query: its key in profiles and, for device queries, its number.
pub(crate) struct Query {
    /// The key in a profile: the query's name in lower case.
    pub key: &'static str,
    /// The number that `clGetDeviceInfo` takes; `None` for queries of platforms and kernels.
    pub device: Option<u32>,
    pub kind: Kind,
}

impl Query {
    /// The table's row with this key.
    pub fn find(key: &str) -> Option<&'static Query> {
        QUERIES.iter().find(|query| query.key == key)
    }

    /// Whether a device of this version with these extensions knows the query. A platform's version does not matter: it may
    /// be newer than its devices, whose drivers end the process when they are asked what they do not know.
    pub fn may_be_asked(&self, version: Option<(u32, u32)>, extensions: &str) -> bool {
        let version = version.unwrap_or((1, 0));
        let has = |name: &str| extensions.split_whitespace().any(|extension| extension == name);
        match self.key {
            "cl_device_half_fp_config" => has("cl_khr_fp16"),
            "cl_device_image_pitch_alignment" | "cl_device_image_base_address_alignment" => {
                version >= (2, 0) || has("cl_khr_image2d_from_buffer")
            }
            "cl_device_double_fp_config" => version >= (1, 2) || has("cl_khr_fp64"),
            "cl_device_image_max_array_size"
            | "cl_device_image_max_buffer_size"
            | "cl_device_linker_available"
            | "cl_device_built_in_kernels"
            | "cl_device_printf_buffer_size" => version >= (1, 2),
            "cl_device_host_unified_memory" | "cl_device_opencl_c_version" => version >= (1, 1),
            _ => true,
        }
    }
}

const TYPES: &[(&str, u64)] = &[
    ("CL_DEVICE_TYPE_CPU", CL_DEVICE_TYPE_CPU),
    ("CL_DEVICE_TYPE_GPU", CL_DEVICE_TYPE_GPU),
    ("CL_DEVICE_TYPE_ACCELERATOR", CL_DEVICE_TYPE_ACCELERATOR),
    ("CL_DEVICE_TYPE_CUSTOM", CL_DEVICE_TYPE_CUSTOM),
];
const FLOATS: &[(&str, u64)] = &[
    ("CL_FP_DENORM", CL_FP_DENORM),
    ("CL_FP_INF_NAN", CL_FP_INF_NAN),
    ("CL_FP_ROUND_TO_NEAREST", CL_FP_ROUND_TO_NEAREST),
    ("CL_FP_ROUND_TO_ZERO", CL_FP_ROUND_TO_ZERO),
    ("CL_FP_ROUND_TO_INF", CL_FP_ROUND_TO_INF),
    ("CL_FP_FMA", CL_FP_FMA),
    ("CL_FP_SOFT_FLOAT", CL_FP_SOFT_FLOAT),
    ("CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT", CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT),
];
const CACHES: &[(&str, u64)] = &[("CL_NONE", 0), ("CL_READ_ONLY_CACHE", 1), ("CL_READ_WRITE_CACHE", 2)];
const LOCALS: &[(&str, u64)] = &[("CL_NONE", 0), ("CL_LOCAL", 1), ("CL_GLOBAL", 2)];
const QUEUES: &[(&str, u64)] = &[("CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE", 1), ("CL_QUEUE_PROFILING_ENABLE", 2)];
const EXECUTES: &[(&str, u64)] = &[("CL_EXEC_KERNEL", 1), ("CL_EXEC_NATIVE_KERNEL", 2)];
/// `CL_DEVICE_QUEUE_PROPERTIES` of OpenCL 1.2, which later headers renamed.
const QUEUE_PROPERTIES: u32 = 0x102A;

const fn device(key: &'static str, number: u32, kind: Kind) -> Query {
    Query { key, device: Some(number), kind }
}

const fn other(key: &'static str, kind: Kind) -> Query {
    Query { key, device: None, kind }
}

/// Every query of the profile schema, in the order of the report.
pub(crate) static QUERIES: &[Query] = &[
    other("cl_platform_name", Kind::Text),
    other("cl_platform_vendor", Kind::Text),
    other("cl_platform_version", Kind::Text),
    other("cl_platform_profile", Kind::Text),
    other("cl_platform_extensions", Kind::Words),
    device("cl_device_type", CL_DEVICE_TYPE, Kind::Choice(TYPES)),
    device("cl_device_name", CL_DEVICE_NAME, Kind::Text),
    device("cl_device_vendor", CL_DEVICE_VENDOR, Kind::Text),
    device("cl_device_vendor_id", CL_DEVICE_VENDOR_ID, Kind::Count),
    device("cl_device_version", CL_DEVICE_VERSION, Kind::Text),
    device("cl_device_opencl_c_version", CL_DEVICE_OPENCL_C_VERSION, Kind::Text),
    device("cl_driver_version", CL_DRIVER_VERSION, Kind::Text),
    device("cl_device_profile", CL_DEVICE_PROFILE, Kind::Text),
    device("cl_device_max_compute_units", CL_DEVICE_MAX_COMPUTE_UNITS, Kind::Size),
    device("cl_device_max_work_item_dimensions", CL_DEVICE_MAX_WORK_ITEM_DIMENSIONS, Kind::Size),
    device("cl_device_max_work_item_sizes", CL_DEVICE_MAX_WORK_ITEM_SIZES, Kind::Sizes3),
    device("cl_device_max_work_group_size", CL_DEVICE_MAX_WORK_GROUP_SIZE, Kind::Size),
    other("cl_kernel_work_group_size", Kind::Size),
    other("cl_kernel_preferred_work_group_size_multiple", Kind::Size),
    device("cl_device_preferred_vector_width_float", CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT, Kind::Count),
    device("cl_device_max_clock_frequency", CL_DEVICE_MAX_CLOCK_FREQUENCY, Kind::Count),
    device("cl_device_address_bits", CL_DEVICE_ADDRESS_BITS, Kind::Size),
    device("cl_device_endian_little", CL_DEVICE_ENDIAN_LITTLE, Kind::Flag),
    device("cl_device_available", CL_DEVICE_AVAILABLE, Kind::Flag),
    device("cl_device_global_mem_size", CL_DEVICE_GLOBAL_MEM_SIZE, Kind::Size),
    device("cl_device_max_mem_alloc_size", CL_DEVICE_MAX_MEM_ALLOC_SIZE, Kind::Size),
    device("cl_device_global_mem_cache_type", CL_DEVICE_GLOBAL_MEM_CACHE_TYPE, Kind::Choice(CACHES)),
    device("cl_device_global_mem_cache_size", CL_DEVICE_GLOBAL_MEM_CACHE_SIZE, Kind::Count),
    device("cl_device_global_mem_cacheline_size", CL_DEVICE_GLOBAL_MEM_CACHELINE_SIZE, Kind::Count),
    device("cl_device_local_mem_type", CL_DEVICE_LOCAL_MEM_TYPE, Kind::Choice(LOCALS)),
    device("cl_device_local_mem_size", CL_DEVICE_LOCAL_MEM_SIZE, Kind::Count),
    device("cl_device_max_constant_buffer_size", CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE, Kind::Size),
    device("cl_device_max_constant_args", CL_DEVICE_MAX_CONSTANT_ARGS, Kind::Size),
    device("cl_device_max_parameter_size", CL_DEVICE_MAX_PARAMETER_SIZE, Kind::Size),
    device("cl_device_mem_base_addr_align", CL_DEVICE_MEM_BASE_ADDR_ALIGN, Kind::Size),
    device("cl_device_min_data_type_align_size", CL_DEVICE_MIN_DATA_TYPE_ALIGN_SIZE, Kind::Count),
    device("cl_device_image_support", CL_DEVICE_IMAGE_SUPPORT, Kind::Flag),
    device("cl_device_image2d_max_width", CL_DEVICE_IMAGE2D_MAX_WIDTH, Kind::Count),
    device("cl_device_image2d_max_height", CL_DEVICE_IMAGE2D_MAX_HEIGHT, Kind::Count),
    device("cl_device_image3d_max_width", CL_DEVICE_IMAGE3D_MAX_WIDTH, Kind::Count),
    device("cl_device_image3d_max_height", CL_DEVICE_IMAGE3D_MAX_HEIGHT, Kind::Count),
    device("cl_device_image3d_max_depth", CL_DEVICE_IMAGE3D_MAX_DEPTH, Kind::Count),
    device("cl_device_image_max_array_size", CL_DEVICE_IMAGE_MAX_ARRAY_SIZE, Kind::Count),
    device("cl_device_image_max_buffer_size", CL_DEVICE_IMAGE_MAX_BUFFER_SIZE, Kind::Count),
    device("cl_device_max_samplers", CL_DEVICE_MAX_SAMPLERS, Kind::Count),
    device("cl_device_max_read_image_args", CL_DEVICE_MAX_READ_IMAGE_ARGS, Kind::Count),
    device("cl_device_max_write_image_args", CL_DEVICE_MAX_WRITE_IMAGE_ARGS, Kind::Count),
    device("cl_device_image_pitch_alignment", CL_DEVICE_IMAGE_PITCH_ALIGNMENT, Kind::Count),
    device("cl_device_image_base_address_alignment", CL_DEVICE_IMAGE_BASE_ADDRESS_ALIGNMENT, Kind::Count),
    device("cl_device_single_fp_config", CL_DEVICE_SINGLE_FP_CONFIG, Kind::Bits(FLOATS)),
    device("cl_device_half_fp_config", CL_DEVICE_HALF_FP_CONFIG, Kind::Bits(FLOATS)),
    device("cl_device_double_fp_config", CL_DEVICE_DOUBLE_FP_CONFIG, Kind::Bits(FLOATS)),
    device("cl_device_host_unified_memory", CL_DEVICE_HOST_UNIFIED_MEMORY, Kind::Flag),
    device("cl_device_error_correction_support", CL_DEVICE_ERROR_CORRECTION_SUPPORT, Kind::Flag),
    device("cl_device_compiler_available", CL_DEVICE_COMPILER_AVAILABLE, Kind::Flag),
    device("cl_device_linker_available", CL_DEVICE_LINKER_AVAILABLE, Kind::Flag),
    device("cl_device_built_in_kernels", CL_DEVICE_BUILT_IN_KERNELS, Kind::Text),
    device("cl_device_printf_buffer_size", CL_DEVICE_PRINTF_BUFFER_SIZE, Kind::Count),
    device("cl_device_queue_properties", QUEUE_PROPERTIES, Kind::Bits(QUEUES)),
    device("cl_device_profiling_timer_resolution", CL_DEVICE_PROFILING_TIMER_RESOLUTION, Kind::Count),
    device("cl_device_execution_capabilities", CL_DEVICE_EXECUTION_CAPABILITIES, Kind::Bits(EXECUTES)),
    device("cl_device_extensions", CL_DEVICE_EXTENSIONS, Kind::Words),
];

#[cfg(test)]
mod tests {
    use super::Query;

    #[test]
    fn a_device_is_asked_what_its_version_has() {
        let asked = |version, extensions: &str, key: &str| {
            Query::find(key).is_some_and(|query| query.may_be_asked(version, extensions))
        };
        let pitch = "cl_device_image_pitch_alignment";
        assert!(!asked(Some((1, 2)), "cl_khr_fp16 cl_khr_image2d_from_buffers", pitch));
        assert!(asked(Some((1, 2)), "cl_khr_fp16 cl_khr_image2d_from_buffer", pitch));
        assert!(asked(Some((2, 0)), "", pitch));
        assert!(!asked(Some((3, 0)), "", "cl_device_half_fp_config"));
        assert!(!asked(None, "", "cl_device_printf_buffer_size"));
        assert!(asked(None, "", "cl_device_name"));
    }
}
