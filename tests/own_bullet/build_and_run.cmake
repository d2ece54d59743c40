# SPDX-License-Identifier: Zlib
# cmake -DHOW=fetch|subdirectory|installed -DSCALAR=float|double -DGENERATOR=<generator> -DBULLET_SOURCE=<folder>
#   -DFEM_SOURCE=<folder> -DBINARY=<folder> -P build_and_run.cmake
# Builds a program with its own Bullet, and runs it. installed: Bullet is built and installed in a folder, BulletFEM is
# built against it with BULLETFEM_BULLET, and the program against both installations.
cmake_minimum_required(VERSION 3.25)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
set(suffix "")
set(double OFF)
if(SCALAR STREQUAL "double")
    set(suffix "-float64")
    set(double ON)
endif()

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()

# configure_and_build(<source> <folder> <option>...)
function(configure_and_build source folder)
    run(${CMAKE_COMMAND} -S "${source}" -B "${folder}" -G "${GENERATOR}" -DCMAKE_BUILD_TYPE=Release ${ARGN})
    run(${CMAKE_COMMAND} --build "${folder}" --parallel ${cores})
endfunction()

set(off "")
foreach(option BUILD_CPU_DEMOS BUILD_BULLET2_DEMOS BUILD_OPENGL3_DEMOS BUILD_UNIT_TESTS BUILD_EXTRAS BUILD_BULLET3)
    list(APPEND off -D${option}=OFF)
endforeach()
if(HOW STREQUAL "installed")
    configure_and_build("${BULLET_SOURCE}" "${BINARY}/bullet" ${off} -DINSTALL_LIBS=ON -DUSE_DOUBLE_PRECISION=${double})
    run(${CMAKE_COMMAND} --install "${BINARY}/bullet" --prefix "${BINARY}/own")
    set(off "")
    foreach(part TESTS DEMOS TOOLS BENCHMARKS PICTURES)
        list(APPEND off -DBULLETFEM_BUILD_${part}=OFF)
    endforeach()
    configure_and_build("${FEM_SOURCE}" "${BINARY}/fem" ${off} -DBULLETFEM_BULLET=${BINARY}/own -DBULLETFEM_UNITY=8)
    run(${CMAKE_COMMAND} --install "${BINARY}/fem" --prefix "${BINARY}/prefix")
    configure_and_build("${FEM_SOURCE}/tests/install" "${BINARY}/game" -DCMAKE_PREFIX_PATH=${BINARY}/prefix)
else()
    configure_and_build("${FEM_SOURCE}/tests/own_bullet" "${BINARY}/game" -DHOW=${HOW} -DSCALAR=${SCALAR}
        -DBULLET_SOURCE=${BULLET_SOURCE} -DFEM_SOURCE=${FEM_SOURCE})
endif()
run("${BINARY}/game/consumer${suffix}")
