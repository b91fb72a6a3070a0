# SPDX-License-Identifier: MIT OR Apache-2.0
# shellcheck shell=bash
# Installs what the scripts of this project need and this machine lacks, from the distribution's packages; quiet where
# nothing is missing. To be sourced after lib.sh, from the repository's root:
#
#   . .ci/setup.sh run    Rust, and PoCL to run the kernels on the CPU
#   . .ci/setup.sh test   also a JDK, Maven, and clang to check kernels as strict OpenCL C 1.2
#   . .ci/setup.sh long   also oclgrind and Mesa's OpenCL
#
# Rust is required. The rest is as good as it can be got: a test whose tool is missing fails and says what it needs.
# Sets `opencl` to yes or no: whether there is an OpenCL loader with a driver.

need_rust

have_opencl() {
    { /sbin/ldconfig -p 2>/dev/null || true; } | grep -q 'libOpenCL\.so\.1 ' || return 1
    [ -n "${OCL_ICD_VENDORS-}" ] || [ -n "$(find /etc/OpenCL/vendors -name '*.icd' 2>/dev/null)" ]
}

if ! have apt-get && have_opencl; then
    :
else
    need_packages "OpenCL on the CPU (PoCL)" ocl-icd-libopencl1 pocl-opencl-icd || true
fi
opencl=no
# shellcheck disable=SC2034 # for the scripts that source this one
! have_opencl || opencl=yes

if [ "$1" = test ] || [ "$1" = long ]; then
    have javac || need_packages "the tests of the JNI library" default-jdk-headless ||
        say "without a JDK the tests of the JNI library fail; RAREFY_TEST_JVM=none waives them" >&2
    # The demo app's screens: files of Maven Central, and a resource linker of PyPI's.
    need_packages "the tests of the demo app's screens" maven python3 python3-pip ||
        say "without Maven and pip the tests of the demo app's screens fail; RAREFY_TEST_SCREENS=none waives them" >&2
    have clang || have clang-14 || need_packages "the tests of the kernels without a device" clang ||
        say "without clang the strict check of the kernels fails; RAREFY_TEST_CLANG=none waives it" >&2
fi
if [ "$1" = long ]; then
    # oclgrind finds data races and uninitialised reads in kernels; it needs the headers of its own clang. Mesa has rusticl.
    need_packages "the long tests of the kernels" oclgrind clang || true
    need_packages "the long tests under rusticl" mesa-opencl-icd || true
fi
