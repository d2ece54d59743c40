# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
# Sourced after install_packages.sh by demos/run.sh and tests/run.sh: gets surface meshes from a Debian package.

mesh_package=libcgal-demo
mesh_archive=usr/share/doc/libcgal-dev/data.tar.gz

# extract_meshes <folder> <path in the archive>...: extracts files or folders from the package without installing it,
# because slim images leave out /usr/share/doc.
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
