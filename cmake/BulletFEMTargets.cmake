# SPDX-License-Identifier: Zlib
# Settings shared by all libraries and programs of this project; none of them is exported to users.

# True in a program with the property BULLETFEM_RUNTIME: it links neither AMD, METIS nor Assimp, uses Eigen if it orders
# at all, and has no createFromSurfaceFile.
set(BULLETFEM_IN_RUNTIME "$<BOOL:$<TARGET_PROPERTY:BULLETFEM_RUNTIME>>")

# bulletfem_defaults(<target>): C++17, warnings, the requested sanitizers, and the public include folder.
function(bulletfem_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_17)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
    if(BUILD_SHARED_LIBS) # hides symbols that are not marked BULLETFEM_API
        set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
    if(BULLETFEM_UNITY)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${BULLETFEM_UNITY})
        # False positive of GCC: in a unity build it takes classes of included source files for classes of headers.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
    if(BULLETFEM_SANITIZE)
        target_compile_options(${target} PRIVATE
            -fsanitize=${BULLETFEM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS) # detects indices beyond the size of a container
        target_link_options(${target} PUBLIC -fsanitize=${BULLETFEM_SANITIZE})
    endif()
endfunction()

# A target's includes are limited to its "rooms": folders of links in the build tree to folders of the source tree.
# Other includes do not compile. bulletfem_room(<name> <folder>...): a folder of links in which these have their own
# paths; those of include/ without it.
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

# bulletfem_library(<name> [INTERNAL] <source>...): the library bulletfem_<name>, exported as BulletFEM::<name>. It is
# shared with BUILD_SHARED_LIBS; its soname then changes with each minor version before 1.0. INTERNAL: a library without
# users' calls, which stays static and becomes part of the shared libraries that link it.
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

# Headers included by most tests, precompiled once for all programs of one kind (with Bullet, in either precision, or
# without), by a program without function. bulletfem_precompile(<program> <kind> LIBS <target>... HEADERS <header>...)
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

# Compile options of all tests and of the precompiled headers.
function(bulletfem_test_flags program)
    bulletfem_defaults(${program})
    # Performance of test code is irrelevant, and this halves its compile time.
    target_compile_options(${program} PRIVATE
        $<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU,Clang>>:-O1>)
    if(BULLETFEM_SANITIZE MATCHES undefined) # checks of the test code itself double its compile time, too
        target_compile_options(${program} PRIVATE -fno-sanitize=undefined)
    endif()
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(${program} PRIVATE ${ARGN} GTest::gtest GTest::gmock GTest::gtest_main)
endfunction()

# With BULLETFEM_TEST_SUITES in its environment, ctest runs each suite of the program as one test instead of each case:
# most cases take less time than starting their process. A suite with a skipped case fails, because the skip would go
# unnoticed.
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
    list(POP_BACK includes cases) # added by gtest_discover_tests
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
# [KIND <kind>  PRECOMPILE <header>...]): one GoogleTest program; ctest knows each test by its name followed by the
# suffix. Programs of equal kind and suffix share precompiled headers. Tests of higher cost start earlier. MAY_SKIP:
# tests may be skipped, so each case is a test, regardless of the environment.
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
