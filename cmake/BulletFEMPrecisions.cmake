# SPDX-License-Identifier: Zlib
# Bullet's two precisions. Targets that include Bullet are built once for each of BULLETFEM_PRECISIONS, with Bullet's
# suffix: none for float, "-float64" for float64. Source lists are written once.
set(BULLETFEM_BULLET "" CACHE STRING "Which Bullet: targets (of this build), system, the folder that it is installed in, or its source tree, \
for static libraries alone; empty: targets where there are some, else system")
set(BULLETFEM_BULLET_MINIMUM 3.23) # docs/compatibility.md, Which Bullet
find_package(BulletPrecisions ${BULLETFEM_BULLET_MINIMUM} REQUIRED OPTIONAL_COMPONENTS float float64)

if(BulletPrecisions_HEADERS_ALONE)
    foreach(_part BULLETFEM_BUILD_TESTS BULLETFEM_BUILD_DEMOS BULLETFEM_BUILD_TOOLS BULLETFEM_BUILD_BENCHMARKS BULLETFEM_PYTHON
            BUILD_SHARED_LIBS)
        if(${_part})
            message(FATAL_ERROR "${_part} is ON, but BULLETFEM_BULLET is a source tree, which has no libraries to link: "
                "set it to OFF, or BULLETFEM_BULLET to an installation")
        endif()
    endforeach()
endif()

set(_found "")
foreach(_precision float float64)
    if(BulletPrecisions_${_precision}_FOUND)
        list(APPEND _found ${_precision})
    endif()
endforeach()
set(BULLETFEM_PRECISIONS "${_found}" CACHE STRING "Bullet's precisions to build for: float, float64 or both")

if(NOT BULLETFEM_PRECISIONS)
    message(FATAL_ERROR "BULLETFEM_PRECISIONS is empty, or no Bullet is found: it must be float, float64 or float;float64; "
        "install libbullet-dev, or set BULLETFEM_BULLET to the folder of your own Bullet")
endif()
foreach(_precision IN LISTS BULLETFEM_PRECISIONS)
    if(NOT _precision MATCHES "^(float|float64)$")
        message(FATAL_ERROR "BULLETFEM_PRECISIONS has ${_precision}: it must be float, float64 or float;float64")
    elseif(NOT _precision IN_LIST _found)
        message(FATAL_ERROR "BULLETFEM_PRECISIONS has ${_precision}, but Bullet is found for ${_found} only: "
            "install libbullet-dev, or leave it out")
    endif()
endforeach()
message(STATUS "Bullet ${BulletPrecisions_VERSION} (${BulletPrecisions_CHOICE}), headers in ${BulletPrecisions_INCLUDE_DIR}, "
    "for ${BULLETFEM_PRECISIONS}")
list(REMOVE_DUPLICATES BULLETFEM_PRECISIONS)

set(BULLETFEM_SUFFIX_float "")
set(BULLETFEM_SUFFIX_float64 "-float64")
# Precision of programs that are built once: float if available.
list(FIND BULLETFEM_PRECISIONS float _float_at)
if(_float_at EQUAL -1)
    set(BULLETFEM_SUFFIX "${BULLETFEM_SUFFIX_float64}")
else()
    set(BULLETFEM_SUFFIX "${BULLETFEM_SUFFIX_float}")
endif()

# bulletfem_in_precision(<variable> <suffix> <target>...): the targets, each with the suffix if such a target exists.
function(bulletfem_in_precision variable suffix)
    set(targets "")
    foreach(target IN LISTS ARGN)
        if(TARGET ${target}${suffix})
            list(APPEND targets ${target}${suffix})
        else()
            list(APPEND targets ${target})
        endif()
    endforeach()
    set(${variable} "${targets}" PARENT_SCOPE)
endfunction()

# Bullet libraries linked by name or by path, as CMake's own FindBullet gives them, carry no BULLET_PRECISION. CMake
# then accepts a mixture of precisions, which bullet_fem/btFemPrecision.h rejects.
set(BULLETFEM_FOREIGN_float "(LinearMath|Bullet(Collision|Dynamics|SoftBody))-float64")
set(BULLETFEM_FOREIGN_float64 "(LinearMath|Bullet(Collision|Dynamics|SoftBody))([.]|$)")

# bulletfem_bullet_library(<name> [INTERNAL] <source>...  SEES <room>...  PUBLIC <target>...  PRIVATE <target>...):
# bulletfem_library for each precision, linked with the targets of that precision.
function(bulletfem_bullet_library name)
    cmake_parse_arguments(ARG "" "" "SEES;PUBLIC;PRIVATE" ${ARGN})
    foreach(precision IN LISTS BULLETFEM_PRECISIONS)
        set(suffix "${BULLETFEM_SUFFIX_${precision}}")
        bulletfem_library(${name}${suffix} ${ARG_UNPARSED_ARGUMENTS})
        bulletfem_sees(bulletfem_${name}${suffix} ${ARG_SEES})
        bulletfem_in_precision(public "${suffix}" ${ARG_PUBLIC})
        bulletfem_in_precision(private "${suffix}" ${ARG_PRIVATE})
        target_link_libraries(bulletfem_${name}${suffix} PUBLIC ${public} PRIVATE ${private})
        # Bullet's targets have it, too; here it also stops users who get Bullet in another way.
        set_target_properties(bulletfem_${name}${suffix} PROPERTIES
            INTERFACE_BULLET_PRECISION ${precision} COMPATIBLE_INTERFACE_STRING BULLET_PRECISION)
        set(foreign "$<FILTER:$<TARGET_PROPERTY:LINK_LIBRARIES>,INCLUDE,${BULLETFEM_FOREIGN_${precision}}>")
        target_compile_definitions(bulletfem_${name}${suffix} PUBLIC BULLETFEM_PRECISION_${precision}
            INTERFACE $<$<BOOL:${foreign}>:BULLETFEM_LINKS_BULLET_OF_OTHER_PRECISION>)
    endforeach()
endfunction()

# bulletfem_bullet_test(<name> <source>...  LIBS <target>...  LABEL <label>  [COST <seconds>]  [SLOW_IN_DOUBLE]):
# bulletfem_test for each precision. In float64, names of the program and of its tests end in "-float64"; SLOW_IN_DOUBLE
# labels them slow. Programs of label slow define BULLETFEM_SLOW_TEST.
function(bulletfem_bullet_test name)
    cmake_parse_arguments(ARG "SLOW_IN_DOUBLE" "LABEL;COST" "LIBS" ${ARGN})
    foreach(precision IN LISTS BULLETFEM_PRECISIONS)
        set(suffix "${BULLETFEM_SUFFIX_${precision}}")
        bulletfem_in_precision(libs "${suffix}" ${ARG_LIBS})
        set(label ${ARG_LABEL})
        if(ARG_SLOW_IN_DOUBLE AND precision STREQUAL float64)
            set(label slow)
        endif()
        bulletfem_test(${name}${suffix} ${ARG_UNPARSED_ARGUMENTS} LIBS ${libs} LABEL ${label} COST ${ARG_COST}
            SUFFIX "${suffix}" KIND -bullet
            PRECOMPILE <BulletSoftBody/btSoftBody.h> <BulletSoftBody/btSoftRigidDynamicsWorld.h>
                <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h> <btBulletDynamicsCommon.h>)
        if(ARG_LABEL STREQUAL slow)
            target_compile_definitions(${name}${suffix} PRIVATE BULLETFEM_SLOW_TEST)
        endif()
    endforeach()
endfunction()
