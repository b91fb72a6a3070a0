// SPDX-License-Identifier: MIT OR Apache-2.0
//! OpenCL status codes as errors that carry the call's name and the code's name.

use crate::Error;

/// The status of an enqueue on a device that ran out of something; also what a phone's watchdog leaves behind.
pub(crate) const OUT_OF_RESOURCES: i32 = -5;
/// The device is gone.
pub(crate) const DEVICE_NOT_AVAILABLE: i32 = -2;
/// A command that was waited for failed.
pub(crate) const EXEC_STATUS_ERROR: i32 = -14;
/// The queue does not work any more.
pub(crate) const INVALID_COMMAND_QUEUE: i32 = -36;
/// A kernel does not build.
pub(crate) const BUILD_PROGRAM_FAILURE: i32 = -11;
/// An object belongs to another context.
pub(crate) const INVALID_CONTEXT: i32 = -34;
/// A kernel got too few or too many arguments.
pub(crate) const INVALID_KERNEL_ARGS: i32 = -52;
/// A range does not lie within its buffer.
pub(crate) const INVALID_VALUE: i32 = -30;
/// The library could not be loaded (a code of the binding, not of OpenCL).
pub(crate) const LIBRARY_NOT_LOADED: i32 = -2000;

/// The name of a status code in the OpenCL 1.2 headers, or of the binding's own two codes.
pub fn name(code: i32) -> &'static str {
    match code {
        0 => "CL_SUCCESS",
        -1 => "CL_DEVICE_NOT_FOUND",
        -2 => "CL_DEVICE_NOT_AVAILABLE",
        -3 => "CL_COMPILER_NOT_AVAILABLE",
        -4 => "CL_MEM_OBJECT_ALLOCATION_FAILURE",
        -5 => "CL_OUT_OF_RESOURCES",
        -6 => "CL_OUT_OF_HOST_MEMORY",
        -7 => "CL_PROFILING_INFO_NOT_AVAILABLE",
        -8 => "CL_MEM_COPY_OVERLAP",
        -9 => "CL_IMAGE_FORMAT_MISMATCH",
        -10 => "CL_IMAGE_FORMAT_NOT_SUPPORTED",
        -11 => "CL_BUILD_PROGRAM_FAILURE",
        -12 => "CL_MAP_FAILURE",
        -13 => "CL_MISALIGNED_SUB_BUFFER_OFFSET",
        -14 => "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST",
        -15 => "CL_COMPILE_PROGRAM_FAILURE",
        -16 => "CL_LINKER_NOT_AVAILABLE",
        -17 => "CL_LINK_PROGRAM_FAILURE",
        -18 => "CL_DEVICE_PARTITION_FAILED",
        -19 => "CL_KERNEL_ARG_INFO_NOT_AVAILABLE",
        -30 => "CL_INVALID_VALUE",
        -31 => "CL_INVALID_DEVICE_TYPE",
        -32 => "CL_INVALID_PLATFORM",
        -33 => "CL_INVALID_DEVICE",
        -34 => "CL_INVALID_CONTEXT",
        -35 => "CL_INVALID_QUEUE_PROPERTIES",
        -36 => "CL_INVALID_COMMAND_QUEUE",
        -37 => "CL_INVALID_HOST_PTR",
        -38 => "CL_INVALID_MEM_OBJECT",
        -39 => "CL_INVALID_IMAGE_FORMAT_DESCRIPTOR",
        -40 => "CL_INVALID_IMAGE_SIZE",
        -41 => "CL_INVALID_SAMPLER",
        -42 => "CL_INVALID_BINARY",
        -43 => "CL_INVALID_BUILD_OPTIONS",
        -44 => "CL_INVALID_PROGRAM",
        -45 => "CL_INVALID_PROGRAM_EXECUTABLE",
        -46 => "CL_INVALID_KERNEL_NAME",
        -47 => "CL_INVALID_KERNEL_DEFINITION",
        -48 => "CL_INVALID_KERNEL",
        -49 => "CL_INVALID_ARG_INDEX",
        -50 => "CL_INVALID_ARG_VALUE",
        -51 => "CL_INVALID_ARG_SIZE",
        -52 => "CL_INVALID_KERNEL_ARGS",
        -53 => "CL_INVALID_WORK_DIMENSION",
        -54 => "CL_INVALID_WORK_GROUP_SIZE",
        -55 => "CL_INVALID_WORK_ITEM_SIZE",
        -56 => "CL_INVALID_GLOBAL_OFFSET",
        -57 => "CL_INVALID_EVENT_WAIT_LIST",
        -58 => "CL_INVALID_EVENT",
        -59 => "CL_INVALID_OPERATION",
        -60 => "CL_INVALID_GL_OBJECT",
        -61 => "CL_INVALID_BUFFER_SIZE",
        -62 => "CL_INVALID_MIP_LEVEL",
        -63 => "CL_INVALID_GLOBAL_WORK_SIZE",
        -64 => "CL_INVALID_PROPERTY",
        -65 => "CL_INVALID_IMAGE_DESCRIPTOR",
        -66 => "CL_INVALID_COMPILER_OPTIONS",
        -67 => "CL_INVALID_LINKER_OPTIONS",
        -68 => "CL_INVALID_DEVICE_PARTITION_COUNT",
        -1001 => "CL_PLATFORM_NOT_FOUND_KHR",
        -2000 => "the OpenCL library could not be loaded",
        -2001 => "the OpenCL library lacks this function",
        _ => "unknown code",
    }
}

/// Whether a call failed because the device or its context is gone, as after a watchdog struck: all that was made on it
/// is lost, a new context may work.
pub(crate) fn is_loss(error: &Error) -> bool {
    const LOSSES: [i32; 5] =
        [DEVICE_NOT_AVAILABLE, OUT_OF_RESOURCES, EXEC_STATUS_ERROR, INVALID_CONTEXT, INVALID_COMMAND_QUEUE];
    matches!(error, Error::OpenCl { code, .. } if LOSSES.contains(code))
}

/// An [`Error::OpenCl`] for `call`.
pub(crate) fn error(call: impl Into<String>, code: i32) -> Error {
    Error::OpenCl { call: call.into(), name: name(code).to_string(), code }
}

/// Turns the status that a call of the binding returned into an [`Error::OpenCl`].
pub(crate) fn check<T>(call: &str, result: std::result::Result<T, i32>) -> crate::Result<T> {
    result.map_err(|code| error(call, code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_agree_with_the_bindings_table() {
        for code in -70..=0 {
            let theirs = cl3::error_codes::error_text(code);
            let ours = name(code);
            // Codes that 1.2 does not define (2.x and later) have no name here.
            assert!(ours == theirs || ours == "unknown code", "{code}: {ours} not {theirs}");
        }
        assert_eq!(name(-5), "CL_OUT_OF_RESOURCES");
        assert_eq!(name(-1001), cl3::error_codes::error_text(-1001));
    }

    #[test]
    fn an_error_names_call_and_code() {
        assert_eq!(error("clFinish", -36).to_string(), "clFinish failed: CL_INVALID_COMMAND_QUEUE (-36)");
    }
}
