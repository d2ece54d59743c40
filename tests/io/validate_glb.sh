#!/usr/bin/env bash
# SPDX-License-Identifier: Zlib
# validate_glb.sh <writer> <folder for its files> <folder of node_modules>: the Khronos validator reports no error,
# warning or hint for the writer's films. Exit code 77 (skipped in CTest) without node or gltf-validator.
set -euo pipefail
writer=$1 folder=$2 modules=$3

if ! command -v node >/dev/null; then
    echo "skipped: there is no node"
    exit 77
fi
NODE_PATH="$modules:$(npm root --global 2>/dev/null || true)"
export NODE_PATH
if ! node -e 'require("gltf-validator")' 2>/dev/null; then
    echo "skipped: gltf-validator is not installed; npm install --prefix ${modules%/node_modules} gltf-validator"
    exit 77
fi
rm -rf "$folder"
mkdir -p "$folder"
"$writer" "$folder"
node - "$folder"/*.glb <<'SCRIPT'
const validator = require('gltf-validator'), fs = require('fs');
async function main()
{
    let problems = 0;
    for (const file of process.argv.slice(2))
    {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
        problems += report.issues.messages.length;
        console.log(`${file}: ${report.info.totalTriangleCount} triangles, ${report.issues.messages.length} issues`);
        for (const issue of report.issues.messages.slice(0, 5)) console.log('    ', JSON.stringify(issue));
    }
    console.log(`gltf-validator ${validator.version()}: ${process.argv.length - 2} files, ${problems} issues`);
    process.exit(problems > 0 ? 1 : 0);
}
main();
SCRIPT
