# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
# Sourced after install_packages.sh by demos/run.sh and tests/run.sh: the surface meshes of a Debian package.

mesh_package=libcgal-demo
mesh_archive=usr/share/doc/libcgal-dev/data.tar.gz

# extract_meshes <folder> <path in the archive>...: takes files or folders out of the package. It need not be installed:
# slim images leave out /usr/share/doc.
extract_meshes()
{
    local into=$1 download
    shift
    mkdir -p "$into"
    if [ -r "/$mesh_archive" ]; then
        tar -xzf "/$mesh_archive" -C "$into" "$@"
        return
    fi
    download=$(mktemp -d "$into/package.XXXXXX")
    (
        cd "$download"
        apt-get download "$mesh_package" || { as_root apt-get update && apt-get download "$mesh_package"; }
        dpkg-deb --fsys-tarfile ./*.deb | tar -xO "./$mesh_archive" | tar -xz -C "$into" "$@"
    ) || { rm -r "$download"; return 1; }
    rm -r "$download"
}
