# SPDX-License-Identifier: Zlib
# Toolchain: Debian's cross compiler for Windows (g++-mingw-w64-x86-64-posix), and Wine to run its programs. The
# compiler's runtime is linked statically. Other libraries are in CMAKE_FIND_ROOT_PATH, set up by tools/ci/windows.sh.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
find_program(BULLETFEM_WINE NAMES wine64 wine64-stable wine)
if(BULLETFEM_WINE)
    set(CMAKE_CROSSCOMPILING_EMULATOR "${BULLETFEM_WINE}")
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
