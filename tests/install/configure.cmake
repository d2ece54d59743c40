# SPDX-License-Identifier: Zlib
# cmake -DCASE=<case> -DSOURCE=<BulletFEM's source> -DPREFIX=<installation> -DBINARY=<folder> -DGENERATOR=<generator>
#   -P configure.cmake
# subproject: a parent project of BulletFEM configures; BulletFEM's sources are optimized, the parent's by its own
# options.
# oldBullet: BulletFEM rejects a Bullet that is too old, before anything is compiled. otherBullet: an installation
# rejects another Bullet than the one it was built with. bulletSource: a source tree of Bullet serves libraries, in both
# precisions, and no programs.
file(REMOVE_RECURSE "${BINARY}")
set(configure ${CMAKE_COMMAND} -B "${BINARY}/build" -G "${GENERATOR}")

# bullet_of(<version>): a folder with dummy headers and libraries of such a Bullet, sufficient for CMake.
function(bullet_of version)
    file(WRITE "${BINARY}/bullet/include/bullet/btBulletDynamicsCommon.h" "")
    file(WRITE "${BINARY}/bullet/include/bullet/LinearMath/btScalar.h" "#define BT_BULLET_VERSION ${version}\n")
    foreach(part LinearMath BulletCollision BulletDynamics BulletSoftBody)
        foreach(suffix "" -float64)
            file(WRITE "${BINARY}/bullet/lib/lib${part}${suffix}.a" "")
            file(WRITE "${BINARY}/bullet/lib/${part}${suffix}.lib" "")
        endforeach()
    endforeach()
endfunction()

# refuses(<message> <argument>...): the configuration fails with a matching message.
function(refuses message)
    execute_process(COMMAND ${configure} ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(REGEX REPLACE "[ \n]+" " " line "${output}") # CMake wraps its messages
    if(result EQUAL 0 OR NOT line MATCHES "${message}")
        message(FATAL_ERROR "exit code ${result}, expected a failure with \"${message}\":\n${output}")
    endif()
endfunction()

if(CASE STREQUAL "subproject")
    execute_process(COMMAND ${configure} -S "${CMAKE_CURRENT_LIST_DIR}/subproject" -DFETCHCONTENT_SOURCE_DIR_BULLETFEM=${SOURCE}
        COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
    file(STRINGS "${BINARY}/build/compile_commands.json" commands REGEX "\"command\":")
    set(ours ${commands})
    list(FILTER ours INCLUDE REGEX "fem/step/stepping[.]cpp")
    if(NOT ours MATCHES " -O[23] ")
        message(FATAL_ERROR "BulletFEM is not optimized: ${ours}")
    endif()
    list(FILTER commands INCLUDE REGEX "game[.]cpp")
    if(NOT commands OR commands MATCHES " -O| -DNDEBUG")
        message(FATAL_ERROR "the parent's program got flags that it did not ask for: ${commands}")
    endif()
elseif(CASE STREQUAL "oldBullet")
    bullet_of(320)
    refuses("unsuitable version \"3[.]20\", but required is at least \"3[.]23\"" -S "${SOURCE}" "-DBULLETFEM_BULLET=${BINARY}/bullet")
elseif(CASE STREQUAL "otherBullet")
    bullet_of(399)
    refuses("unsuitable version \"3[.]99\", but required is exact version" -S "${CMAKE_CURRENT_LIST_DIR}"
        "-DBULLETFEM_BULLET=${BINARY}/bullet" "-DCMAKE_PREFIX_PATH=${PREFIX}")
elseif(CASE STREQUAL "bulletSource")
    bullet_of(399)
    file(RENAME "${BINARY}/bullet/include/bullet" "${BINARY}/bullet/src")
    refuses("BULLETFEM_BUILD_TESTS is ON, but BULLETFEM_BULLET is a source tree" -S "${SOURCE}" "-DBULLETFEM_BULLET=${BINARY}/bullet")
    set(off "")
    foreach(part TESTS DEMOS TOOLS BENCHMARKS PICTURES)
        list(APPEND off -DBULLETFEM_BUILD_${part}=OFF)
    endforeach()
    execute_process(COMMAND ${configure} -S "${SOURCE}" "-DBULLETFEM_BULLET=${BINARY}/bullet" ${off} -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
        COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
    file(READ "${BINARY}/build/compile_commands.json" commands)
    foreach(flag "${BINARY}/bullet/src" "BT_USE_DOUBLE_PRECISION" "BULLETFEM_PRECISION_float ")
        string(FIND "${commands}" "${flag}" at)
        if(at EQUAL -1)
            message(FATAL_ERROR "no command of the libraries has ${flag}")
        endif()
    endforeach()
else()
    message(FATAL_ERROR "unknown case: ${CASE}")
endif()
