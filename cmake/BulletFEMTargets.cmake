# SPDX-License-Identifier: Zlib
# What every library and program of this project has in common. Nothing of it is exported to users.

# bulletfem_defaults(<target>): C++17, warnings, the sanitizers asked for, and the public include folder.
function(bulletfem_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_17)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
    if(BULLETFEM_SANITIZE)
        target_compile_options(${target} PRIVATE
            -fsanitize=${BULLETFEM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_link_options(${target} PUBLIC -fsanitize=${BULLETFEM_SANITIZE})
    endif()
endfunction()

# bulletfem_library(<name> <source>...): the static library bulletfem_<name>, known to users as BulletFEM::<name>.
function(bulletfem_library name)
    add_library(bulletfem_${name} STATIC ${ARGN})
    add_library(BulletFEM::${name} ALIAS bulletfem_${name})
    set_target_properties(bulletfem_${name} PROPERTIES EXPORT_NAME ${name})
    bulletfem_defaults(bulletfem_${name})
    target_include_directories(bulletfem_${name}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
        PRIVATE ${PROJECT_SOURCE_DIR})
endfunction()

# bulletfem_test(<name> <source>...  LIBS <target>...  LABEL <label>  [SUFFIX <suffix>]): one GoogleTest program; each test
# is known to ctest, by its name with the suffix behind.
function(bulletfem_test name)
    cmake_parse_arguments(ARG "" "LABEL;SUFFIX" "LIBS" ${ARGN})
    add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
    bulletfem_defaults(${name})
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gmock GTest::gtest_main)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_SUFFIX "${ARG_SUFFIX}"
        PROPERTIES TIMEOUT 600 LABELS "${ARG_LABEL}")
endfunction()
