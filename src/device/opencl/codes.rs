// SPDX-License-Identifier: MIT OR Apache-2.0
//! OpenCL status codes as errors that carry the call's name and the code's name.

pub(crate) use cl3::error_codes::{
    CL_BUILD_PROGRAM_FAILURE as BUILD_PROGRAM_FAILURE, CL_DEVICE_NOT_AVAILABLE as DEVICE_NOT_AVAILABLE,
    CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST as EXEC_STATUS_ERROR,
    CL_INVALID_COMMAND_QUEUE as INVALID_COMMAND_QUEUE, CL_INVALID_CONTEXT as INVALID_CONTEXT,
    CL_INVALID_KERNEL_ARGS as INVALID_KERNEL_ARGS, CL_INVALID_VALUE as INVALID_VALUE,
    CL_OUT_OF_RESOURCES as OUT_OF_RESOURCES,
};

use crate::Error;

/// The library could not be loaded (a code of the binding, not of OpenCL).
pub(crate) const LIBRARY_NOT_LOADED: i32 = -2000;
/// The library lacks a function (a code of the binding, not of OpenCL).
const FUNCTION_NOT_FOUND: i32 = -2001;

/// The name of a status code in the OpenCL headers, or of the binding's own two codes.
pub fn name(code: i32) -> &'static str {
    match code {
        LIBRARY_NOT_LOADED => "the OpenCL library could not be loaded",
        FUNCTION_NOT_FOUND => "the OpenCL library lacks this function",
        _ => cl3::error_codes::error_text(code),
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
    fn codes_have_the_names_of_the_headers() {
        for (code, wanted) in [
            (-5, "CL_OUT_OF_RESOURCES"),
            (-54, "CL_INVALID_WORK_GROUP_SIZE"),
            (-1001, "CL_PLATFORM_NOT_FOUND_KHR"),
            (-2000, "the OpenCL library could not be loaded"),
            (-123_456, "UNKNOWN_ERROR"),
        ] {
            assert_eq!(name(code), wanted);
        }
        assert_eq!(
            [BUILD_PROGRAM_FAILURE, INVALID_COMMAND_QUEUE, OUT_OF_RESOURCES, INVALID_CONTEXT],
            [-11, -36, -5, -34]
        );
    }

    #[test]
    fn an_error_names_call_and_code() {
        assert_eq!(error("clFinish", -36).to_string(), "clFinish failed: CL_INVALID_COMMAND_QUEUE (-36)");
    }
}
