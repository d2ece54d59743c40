# SPDX-License-Identifier: Zlib
# The layers ("floors") of fem.

# bulletfem_floor(<name> <source>...  [SEES <room>...]): the object library bulletfem_fem_<name> of the folder
# fem/<name>. Its include path has that folder, the public headers include/bullet_fem/fem/<name>, and the rooms (include
# folders) of the floors below it. Others include it through the room fem-<name>. The global property
# BULLETFEM_FLOOR_OBJECTS lists the objects of all floors.
function(bulletfem_floor name)
    cmake_parse_arguments(ARG "" "" "SEES" ${ARGN})
    bulletfem_room(fem-${name} fem/${name} include/bullet_fem/fem/${name})
    add_library(bulletfem_fem_${name} OBJECT ${ARG_UNPARSED_ARGUMENTS})
    set_property(GLOBAL APPEND PROPERTY BULLETFEM_FLOOR_OBJECTS $<TARGET_OBJECTS:bulletfem_fem_${name}>)
    bulletfem_defaults(bulletfem_fem_${name})
    bulletfem_sees(bulletfem_fem_${name} fem-${name} ${ARG_SEES})
    # Batched bodies get bitwise the results of single bodies only if the compiler rounds equally in both.
    target_compile_options(bulletfem_fem_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
    # Kernels are short loops: without alignment, unrelated changes of code could shift them and cost 5 % of a step.
    target_compile_options(bulletfem_fem_${name} PRIVATE
        $<$<CXX_COMPILER_ID:GNU>:-falign-functions=64$<SEMICOLON>-falign-loops=32>)
    target_link_libraries(bulletfem_fem_${name} PRIVATE Eigen3::Eigen hwy::hwy ${BULLETFEM_TBB})
endfunction()
