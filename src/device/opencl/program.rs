// SPDX-License-Identifier: MIT OR Apache-2.0
//! Programs and their kernels: built from source or taken from the cache.

use std::ffi::{CString, c_void};
use std::sync::Arc;

use opencl3::kernel::{
    CL_KERNEL_ARG_ADDRESS_CONSTANT, CL_KERNEL_ARG_ADDRESS_QUALIFIER, CL_KERNEL_LOCAL_MEM_SIZE, CL_KERNEL_NUM_ARGS,
    CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE, CL_KERNEL_PRIVATE_MEM_SIZE, CL_KERNEL_WORK_GROUP_SIZE, create_kernel,
    get_kernel_arg_data, get_kernel_data, get_kernel_work_group_data,
};
use opencl3::program::{
    CL_PROGRAM_BINARIES, CL_PROGRAM_BUILD_LOG, build_program, create_program_with_binary, create_program_with_source,
    get_program_build_data, get_program_info,
};

use super::cache::Key;
use super::codes::{self, check};
use super::context::{Context, Shared};
use super::discover::text;
use super::handle::Handle;
use super::{build_log, codes::BUILD_PROGRAM_FAILURE};
use crate::{Error, Result};

/// Options that every program is built with. Argument info is for the check of `constant` arguments.
const ALWAYS: &str = "-cl-std=CL1.2 -Werror -cl-kernel-arg-info";

/// The text of a program.
#[derive(Debug, Clone, Copy)]
pub struct ProgramSource<'a> {
    /// The program's name in errors, after its stages.
    pub name: &'a str,
    /// OpenCL C 1.2, its files joined with `#line` marks (see [`build_log::assemble`]).
    pub source: &'a str,
    /// Build options besides those that are always used: `-D NAME=VALUE` and the like. No `-cl-std`.
    pub options: &'a str,
}

/// A built program.
pub struct Program {
    program: Handle,
    shared: Arc<Shared>,
    name: String,
    from_cache: bool,
}

/// A kernel of a program.
pub struct Kernel {
    kernel: Handle,
    shared: Arc<Shared>,
    name: String,
    arguments: usize,
    constants: Vec<bool>,
    work_group_size: u64,
    local_mem_bytes: u64,
    private_mem_bytes: u64,
    preferred_multiple: u64,
}

impl Context {
    /// Builds a program, or takes it from the cache if the same source was built with the same options for this device
    /// and driver before.
    ///
    /// A source that does not compile is [`Error::KernelBuild`] with kernel files and lines; one that switches on an
    /// extension that the device or profile lacks is [`Error::LimitExceeded`].
    pub fn program(&self, source: &ProgramSource) -> Result<Program> {
        let what = format!("program `{}`", source.name);
        if source.options.contains("-cl-std") {
            return Err(Error::argument(what, "the language version is fixed: no -cl-std among its options"));
        }
        self.limits().check_version(&what, (1, 2))?;
        for extension in switched_on(source.source) {
            self.limits().check_extension(&what, extension)?;
        }
        let options = format!("{ALWAYS} {}", source.options);
        let info = self.info();
        let key = Key::new(&[
            &info.platform,
            &info.name,
            &info.version,
            &info.driver,
            &options,
            source.source,
            env!("CARGO_PKG_VERSION"),
        ]);
        let c_options =
            CString::new(options).map_err(|_| Error::argument(&what, "its options contain a NUL character"))?;
        let make = |program, from_cache| Program {
            program,
            shared: self.shared.clone(),
            name: source.name.to_string(),
            from_cache,
        };
        if let Some(binary) = self.cache.load(&key) {
            match self.build_binary(&binary, &c_options) {
                Ok(program) => return Ok(make(program, true)),
                Err(code) => {
                    log::info!("{what}: the driver refuses its cached binary ({}), built anew", codes::name(code));
                    self.cache.remove(&key);
                }
            }
        }
        let program = self.build_source(source, &c_options).map_err(|error| self.unless_cancelled(error))?;
        if self.cache.is_on()
            && let Some(binary) = binary(&program)
        {
            self.cache.store(&key, &binary);
        }
        Ok(make(program, false))
    }

    fn build_binary(&self, binary: &[u8], options: &CString) -> std::result::Result<Handle, i32> {
        let device = self.shared.device.0;
        // SAFETY: the context holds this device, and exactly one binary is given.
        let raw = unsafe { create_program_with_binary(self.shared.context.raw(), &[device], &[binary]) }?;
        let program = Handle::program(raw);
        build_program(program.raw(), &[device], options, None, std::ptr::null_mut())?;
        Ok(program)
    }

    fn build_source(&self, source: &ProgramSource, options: &CString) -> Result<Handle> {
        let device = self.shared.device.0;
        // One text only: the binding takes an array of Rust strings for an array of C pointers, which holds for one.
        let raw = create_program_with_source(self.shared.context.raw(), &[source.source]);
        let program = Handle::program(check("clCreateProgramWithSource", raw)?);
        match build_program(program.raw(), &[device], options, None, std::ptr::null_mut()) {
            Ok(()) => Ok(program),
            Err(BUILD_PROGRAM_FAILURE) => {
                let log = get_program_build_data(program.raw(), device, CL_PROGRAM_BUILD_LOG);
                let log = log.map(|log| text(&log)).unwrap_or_default();
                Err(Error::KernelBuild {
                    program: source.name.to_string(),
                    device: self.info().describe(),
                    log: build_log::report(&log, source.source),
                })
            }
            Err(code) => Err(codes::error(format!("clBuildProgram of `{}`", source.name), code)),
        }
    }
}

/// The compiled form of a program of one device, if the driver gives it out.
fn binary(program: &Handle) -> Option<Vec<u8>> {
    let opencl3_binaries: Vec<Vec<u8>> = match get_program_info(program.raw(), CL_PROGRAM_BINARIES).ok()? {
        cl3::info_type::InfoType::VecVecUchar(binaries) => binaries,
        _ => return None,
    };
    opencl3_binaries.into_iter().next().filter(|binary| !binary.is_empty())
}

/// The extensions that a source switches on by `#pragma OPENCL EXTENSION name : enable`.
fn switched_on(source: &str) -> impl Iterator<Item = &str> {
    source.lines().filter_map(|line| {
        let mut words = line.trim_start().strip_prefix('#')?.split([' ', '\t', ':']).filter(|word| !word.is_empty());
        let is = [words.next()?, words.next()?, words.next()?] == ["pragma", "OPENCL", "EXTENSION"];
        let name = words.next()?;
        (is && matches!(words.next()?.trim(), "enable" | "require")).then_some(name)
    })
}

impl Program {
    /// The program's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it came from the cache.
    pub fn is_from_cache(&self) -> bool {
        self.from_cache
    }

    /// The kernel function `name` of the program.
    pub fn kernel(&self, name: &str) -> Result<Kernel> {
        let call = || format!("clCreateKernel of `{name}` in `{}`", self.name);
        // CL_INVALID_KERNEL_NAME
        let c_name = CString::new(name).map_err(|_| codes::error(call(), -46))?;
        let raw = create_kernel(self.program.raw(), &c_name).map_err(|code| codes::error(call(), code))?;
        let kernel = Handle::kernel(raw);
        let device = self.shared.device.0;
        let group = |query: u32| get_kernel_work_group_data(kernel.raw(), device, query).ok().and_then(number);
        let arguments = get_kernel_data(kernel.raw(), CL_KERNEL_NUM_ARGS).ok().and_then(number);
        let Some(arguments) = arguments.and_then(|count| u32::try_from(count).ok()) else {
            return Err(codes::error("clGetKernelInfo of CL_KERNEL_NUM_ARGS", codes::INVALID_VALUE));
        };
        // Programs from binaries may not know; real devices then check by themselves.
        let constants = (0..arguments).map(|index| {
            let data = get_kernel_arg_data(kernel.raw(), index, CL_KERNEL_ARG_ADDRESS_QUALIFIER);
            data.ok().and_then(number) == Some(u64::from(CL_KERNEL_ARG_ADDRESS_CONSTANT))
        });
        let constants = constants.collect();
        Ok(Kernel {
            name: name.to_string(),
            arguments: arguments as usize,
            constants,
            work_group_size: group(CL_KERNEL_WORK_GROUP_SIZE).unwrap_or(u64::MAX),
            local_mem_bytes: group(CL_KERNEL_LOCAL_MEM_SIZE).unwrap_or(0),
            private_mem_bytes: group(CL_KERNEL_PRIVATE_MEM_SIZE).unwrap_or(0),
            preferred_multiple: group(CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE).unwrap_or(1),
            shared: self.shared.clone(),
            kernel,
        })
    }
}

/// A number of 4 or 8 bytes, as `size_t` is either.
fn number(bytes: Vec<u8>) -> Option<u64> {
    match bytes.len() {
        4 => bytes.try_into().ok().map(|bytes| u32::from_ne_bytes(bytes).into()),
        _ => bytes.try_into().ok().map(u64::from_ne_bytes),
    }
}

impl Kernel {
    /// The kernel function's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The number of arguments.
    pub fn arguments(&self) -> usize {
        self.arguments
    }

    /// `CL_KERNEL_WORK_GROUP_SIZE`: the most work-items of a work-group of this kernel on this device.
    pub fn work_group_size(&self) -> u64 {
        self.work_group_size
    }

    /// `CL_KERNEL_LOCAL_MEM_SIZE`: local memory that the kernel declares itself, in bytes.
    pub fn local_mem_bytes(&self) -> u64 {
        self.local_mem_bytes
    }

    /// `CL_KERNEL_PRIVATE_MEM_SIZE`: private memory of a work-item, in bytes; more than 0 on a phone may mean spilling.
    pub fn private_mem_bytes(&self) -> u64 {
        self.private_mem_bytes
    }

    /// `CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE`.
    pub fn preferred_multiple(&self) -> u64 {
        self.preferred_multiple
    }

    pub(super) fn is_constant(&self, argument: usize) -> bool {
        self.constants.get(argument).copied().unwrap_or(false)
    }

    pub(super) fn raw(&self) -> *mut c_void {
        self.kernel.raw()
    }

    pub(super) fn belongs_to(&self, context: &Context) -> bool {
        Arc::ptr_eq(&self.shared, &context.shared)
    }
}

impl std::fmt::Debug for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Program `{}`", self.name)
    }
}

impl std::fmt::Debug for Kernel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Kernel `{}`", self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_in_use_are_found() {
        let source = "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n  # pragma OPENCL EXTENSION cl_khr_fp16: disable\n\
                      #pragma OPENCL FP_CONTRACT OFF\n#pragma OPENCL EXTENSION cl_x:enable\r\n// cl_khr_y\n#define A\n";
        assert_eq!(switched_on(source).collect::<Vec<_>>(), ["cl_khr_fp64", "cl_x"]);
    }
}
