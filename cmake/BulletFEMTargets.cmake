# SPDX-License-Identifier: Zlib
# What every library and program of this project has in common. Nothing of it is exported to users.

# True in a program with the property BULLETFEM_RUNTIME: it links neither AMD, METIS nor Assimp, orders with Eigen
# where it orders at all, and has no createFromSurfaceFile.
set(BULLETFEM_IN_RUNTIME "$<BOOL:$<TARGET_PROPERTY:BULLETFEM_RUNTIME>>")

# bulletfem_defaults(<target>): C++17, warnings, the sanitizers asked for, and the public include folder.
function(bulletfem_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_17)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
    if(BUILD_SHARED_LIBS) # what is not marked BULLETFEM_API stays inside
        set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
    if(BULLETFEM_UNITY)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${BULLETFEM_UNITY})
        # GCC takes a class in a source file that such a unit includes for one of a header.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
    if(BULLETFEM_SANITIZE)
        target_compile_options(${target} PRIVATE
            -fsanitize=${BULLETFEM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS) # indices into what is reserved but not there
        target_link_options(${target} PUBLIC -fsanitize=${BULLETFEM_SANITIZE})
    endif()
endfunction()

# What a target may include is what it sees: folders of the source tree, each behind a link in the build tree, so that an
# include of any other does not compile. bulletfem_room(<name> <folder>...): a folder of links, in which these stand at
# their own paths; those of include/ without it.
function(bulletfem_room name)
    foreach(folder IN LISTS ARGN)
        string(REGEX REPLACE "^include/" "" place "${folder}")
        set(link "${PROJECT_BINARY_DIR}/rooms/${name}/${place}")
        get_filename_component(parent "${link}" DIRECTORY)
        file(MAKE_DIRECTORY "${parent}")
        file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${folder}" "${link}" SYMBOLIC)
    endforeach()
endfunction()

# bulletfem_sees(<target> <room>...)
function(bulletfem_sees target)
    foreach(room IN LISTS ARGN)
        target_include_directories(${target} PRIVATE "${PROJECT_BINARY_DIR}/rooms/${room}")
    endforeach()
endfunction()

# bulletfem_library(<name> [INTERNAL] <source>...): the library bulletfem_<name>, known to users as BulletFEM::<name>. It is
# shared with BUILD_SHARED_LIBS, and then programs go with all that have its soname: before 1.0 a minor version is a new
# interface. INTERNAL: no user calls it; it stays static, and becomes part of the shared libraries that link it.
function(bulletfem_library name)
    cmake_parse_arguments(ARG "INTERNAL" "" "" ${ARGN})
    set(kind STATIC)
    if(BUILD_SHARED_LIBS AND NOT ARG_INTERNAL)
        set(kind SHARED)
    endif()
    add_library(bulletfem_${name} ${kind} ${ARG_UNPARSED_ARGUMENTS})
    if(kind STREQUAL SHARED)
        target_link_options(bulletfem_${name} PRIVATE "LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/bulletfem.map")
        set_property(TARGET bulletfem_${name} APPEND PROPERTY LINK_DEPENDS "${PROJECT_SOURCE_DIR}/cmake/bulletfem.map")
        set_property(GLOBAL APPEND PROPERTY BULLETFEM_SHARED_LIBRARIES bulletfem_${name})
    endif()
    set_target_properties(bulletfem_${name} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    add_library(BulletFEM::${name} ALIAS bulletfem_${name})
    set_target_properties(bulletfem_${name} PROPERTIES EXPORT_NAME ${name})
    bulletfem_defaults(bulletfem_${name})
    target_include_directories(bulletfem_${name}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# Headers that most tests include, compiled once for all programs of one kind (what sees Bullet, in either precision, and
# the rest), by a program that does nothing. bulletfem_precompile(<program> <kind> LIBS <target>... HEADERS <header>...)
function(bulletfem_precompile program kind)
    if(NOT BULLETFEM_PRECOMPILE)
        return()
    endif()
    cmake_parse_arguments(ARG "" "" "LIBS;HEADERS" ${ARGN})
    set(owner bulletfem_precompiled${kind})
    if(NOT TARGET ${owner})
        file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "int main() {}\n")
        add_executable(${owner} "${PROJECT_BINARY_DIR}/precompiled.cpp")
        bulletfem_test_flags(${owner} ${ARG_LIBS})
        target_precompile_headers(${owner} PRIVATE ${ARG_HEADERS})
    endif()
    target_precompile_headers(${program} REUSE_FROM ${owner})
endfunction()

# What all tests are compiled with, and the precompiled headers, too.
function(bulletfem_test_flags program)
    bulletfem_defaults(${program})
    # Tests call what is measured, they are not it: half the time to compile.
    target_compile_options(${program} PRIVATE
        $<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU,Clang>>:-O1>)
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(${program} PRIVATE ${ARGN} GTest::gtest GTest::gmock GTest::gtest_main)
endfunction()

# Makes ctest run each suite of the program as one test, and not each case, if BULLETFEM_TEST_SUITES is in its environment:
# most cases take less time than their process does to start. A suite that skips a case fails, as nobody would see it.
function(bulletfem_test_suites name suffix properties)
    set(suites "${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake")
    list(APPEND properties FAIL_REGULAR_EXPRESSION ".  SKIPPED .")
    list(JOIN properties "]=] [=[" properties)
    add_custom_command(TARGET ${name} POST_BUILD BYPRODUCTS "${suites}" VERBATIM
        COMMAND ${CMAKE_COMMAND} "-DPROGRAM=$<TARGET_FILE:${name}>" "-DNAME_SUFFIX=${suffix}" "-DOUTPUT=${suites}"
            "-DEMULATOR=${CMAKE_CROSSCOMPILING_EMULATOR}" "-DPROPERTIES=[=[${properties}]=]"
            -P "${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake")
    set(chosen "${CMAKE_CURRENT_BINARY_DIR}/${name}_chosen.cmake")
    get_property(includes DIRECTORY PROPERTY TEST_INCLUDE_FILES)
    list(POP_BACK includes cases) # what gtest_discover_tests has just added
    file(CONFIGURE OUTPUT "${chosen}" @ONLY CONTENT [=[
if(DEFINED ENV{BULLETFEM_TEST_SUITES} AND EXISTS "@suites@")
    include("@suites@")
else()
    include("@cases@")
endif()
]=])
    set_property(DIRECTORY PROPERTY TEST_INCLUDE_FILES "${includes}" "${chosen}")
endfunction()

# bulletfem_test(<name> <source>...  LIBS <target>...  LABEL <label>  [SUFFIX <suffix>]  [COST <seconds>]  [MAY_SKIP]
# [KIND <kind>  PRECOMPILE <header>...]): one GoogleTest program; each test is known to ctest, by its name with the suffix
# behind. Programs of the same kind and suffix share precompiled headers. What costs more is started earlier; MAY_SKIP is
# for programs whose tests may be skipped: each case is a test then, whatever the environment says.
function(bulletfem_test name)
    cmake_parse_arguments(ARG "MAY_SKIP" "LABEL;SUFFIX;KIND;COST" "LIBS;PRECOMPILE" ${ARGN})
    add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
    bulletfem_test_flags(${name} ${ARG_LIBS})
    bulletfem_precompile(${name} "${ARG_SUFFIX}${ARG_KIND}" LIBS ${ARG_LIBS}
        HEADERS <gtest/gtest.h> <algorithm> <cmath> <memory> <sstream> <string> <vector> ${ARG_PRECOMPILE})
    if(NOT ARG_COST)
        set(ARG_COST 0)
        if(ARG_LABEL STREQUAL slow)
            set(ARG_COST 10)
        endif()
    endif()
    if(ARG_LABEL STREQUAL slow AND NOT BULLETFEM_BUILD_SLOW_TESTS)
        set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
        return()
    endif()
    set(properties TIMEOUT 600 LABELS "${ARG_LABEL}" COST ${ARG_COST})
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_SUFFIX "${ARG_SUFFIX}" PROPERTIES ${properties})
    if(NOT ARG_MAY_SKIP)
        bulletfem_test_suites(${name} "${ARG_SUFFIX}" "${properties}")
    endif()
endfunction()
