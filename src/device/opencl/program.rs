// SPDX-License-Identifier: MIT OR Apache-2.0
//! Programs and their kernels: built from source or taken from the cache.

use std::ffi::{CString, c_void};
use std::sync::{Arc, Mutex};

use opencl3::kernel::{
    CL_KERNEL_ARG_ADDRESS_CONSTANT, CL_KERNEL_ARG_ADDRESS_QUALIFIER, CL_KERNEL_FUNCTION_NAME, CL_KERNEL_LOCAL_MEM_SIZE,
    CL_KERNEL_NUM_ARGS, CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE, CL_KERNEL_PRIVATE_MEM_SIZE,
    CL_KERNEL_WORK_GROUP_SIZE, create_kernel, create_kernels_in_program, get_kernel_arg_data, get_kernel_data,
    get_kernel_work_group_data,
};
use opencl3::program::{
    CL_PROGRAM_BINARIES, CL_PROGRAM_BUILD_LOG, build_program, create_program_with_binary, create_program_with_source,
    get_program_build_data, get_program_info,
};

use super::cache::Key;
use super::codes::{self, check};
use super::context::{Context, Shared, lock};
use super::discover::text;
use super::handle::Handle;
use super::{build_log, codes::BUILD_PROGRAM_FAILURE};
use crate::{Error, Result};

/// Options that every program is built with. Argument info is for the check of `constant` arguments.
const ALWAYS: &str = "-cl-std=CL1.2 -Werror -cl-kernel-arg-info";

/// What a careful build has besides.
const CAREFUL: &str = "-cl-opt-disable";

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
    /// Its kernels with their names, until they are asked for.
    created: Mutex<Vec<(String, Handle)>>,
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
    /// and driver before. Kernels are created at once: some drivers compile only then, and a binary that is taken before
    /// is of no use.
    ///
    /// A source that does not compile is [`Error::KernelBuild`] with kernel files and lines, from then on without asking
    /// this driver again; one that switches on an extension that the device or profile lacks is
    /// [`Error::LimitExceeded`]. [`Error::DriverCrashed`] if a process ended in the compiler before.
    pub fn program(&self, source: &ProgramSource) -> Result<Program> {
        let what = format!("program `{}`", source.name);
        if source.options.contains("-cl-std") {
            return Err(Error::argument(what, "the language version is fixed: no -cl-std among its options"));
        }
        self.limits().check_version(&what, (1, 2))?;
        for extension in switched_on(source.source) {
            self.limits().check_extension(&what, extension)?;
        }
        let careful = if self.is_careful() { CAREFUL } else { "" };
        let options = format!("{ALWAYS} {} {careful}", source.options);
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
        let make = |(program, created), from_cache| Program {
            program,
            shared: self.shared.clone(),
            name: source.name.to_string(),
            from_cache,
            created: Mutex::new(created),
        };
        let kept = if self.retries() { None } else { self.failures.load(&key) };
        if let Some(log) = kept {
            let log = format!("as an earlier start found:\n{}", String::from_utf8_lossy(&log));
            return Err(self.build_error(source, log));
        }
        let work = format!("building program `{}`", source.name);
        let marker = self.markers.guard(&key, &info.describe(), &work)?;
        if let Some(binary) = self.cache.load(&key) {
            match self.build_binary(&binary, &c_options) {
                Ok(built) => return Ok(make(built, true)),
                Err(code) => {
                    log::info!("{what}: the driver refuses its cached binary ({}), built anew", codes::name(code));
                    self.cache.remove(&key);
                }
            }
        }
        let built = self.build_source(source, &c_options).map_err(|error| self.unless_cancelled(error));
        drop(marker);
        if let Err(Error::KernelBuild { log, .. }) = &built {
            self.failures.store(&key, log.as_bytes());
        }
        let built = built?;
        self.failures.remove(&key);
        if self.cache.is_on()
            && let Some(binary) = binary(&built.0)
        {
            self.cache.store(&key, &binary);
        }
        Ok(make(built, false))
    }

    fn build_error(&self, source: &ProgramSource, log: String) -> Error {
        Error::KernelBuild { program: source.name.to_string(), device: self.info().describe(), log }
    }

    fn build_binary(&self, binary: &[u8], options: &CString) -> std::result::Result<Built, i32> {
        let device = self.shared.device.0;
        // SAFETY: the context holds this device, and exactly one binary is given.
        let raw = unsafe { create_program_with_binary(self.shared.context.raw(), &[device], &[binary]) }?;
        let program = Handle::program(raw);
        build_program(program.raw(), &[device], options, None, std::ptr::null_mut())?;
        let created = create_kernels(&program)?;
        Ok((program, created))
    }

    fn build_source(&self, source: &ProgramSource, options: &CString) -> Result<Built> {
        let device = self.shared.device.0;
        // One text only: the binding takes an array of Rust strings for an array of C pointers, which holds for one.
        let raw = create_program_with_source(self.shared.context.raw(), &[source.source]);
        let program = Handle::program(check("clCreateProgramWithSource", raw)?);
        let failed = |call: &str, code| {
            let error = codes::error(format!("{call} of `{}`", source.name), code);
            // A device that is gone says nothing about the program.
            if codes::is_loss(&error) {
                return error;
            }
            let log = get_program_build_data(program.raw(), device, CL_PROGRAM_BUILD_LOG);
            let log = build_log::report(&log.map(|log| text(&log)).unwrap_or_default(), source.source);
            let log = if code == BUILD_PROGRAM_FAILURE { log } else { format!("{error}\n{log}") };
            self.build_error(source, log)
        };
        build_program(program.raw(), &[device], options, None, std::ptr::null_mut())
            .map_err(|code| failed("clBuildProgram", code))?;
        let created = create_kernels(&program).map_err(|code| failed("clCreateKernelsInProgram", code))?;
        Ok((program, created))
    }
}

/// A program with its kernels and their names.
type Built = (Handle, Vec<(String, Handle)>);

fn create_kernels(program: &Handle) -> std::result::Result<Vec<(String, Handle)>, i32> {
    let kernels = create_kernels_in_program(program.raw())?.into_iter().map(Handle::kernel);
    kernels.map(|kernel| Ok((text(&get_kernel_data(kernel.raw(), CL_KERNEL_FUNCTION_NAME)?), kernel))).collect()
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
        let created = {
            let mut created = lock(&self.created);
            created.iter().position(|(of, _)| of == name).map(|at| created.swap_remove(at).1)
        };
        let kernel = match created {
            Some(kernel) => kernel,
            None => {
                Handle::kernel(create_kernel(self.program.raw(), &c_name).map_err(|code| codes::error(call(), code))?)
            }
        };
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
