#!/usr/bin/env bash
# make_references.sh BIN: writes the references that programs make of themselves.
set -euo pipefail
bin=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
page() { printf '# %s\n\n%s\n\n' "$1" "$2"; }
note='Plain numbers are SI; texts may carry units ("0.8 mm", "1.59 g/s"). Unknown keys are errors. This page is made by'
{ page "Scene keys" "$note \`granrun keys\`."; "$bin/granrun" keys --md; } >scene.md
{ page "Keys of studies" "$note \`granrun keys study\`. What they mean together: [study.md](study.md)."; "$bin/granrun" keys study --md; } >study_keys.md
{ page "Keys of correlation tables" "$note \`granrun keys table\`."; "$bin/granrun" keys table --md; } >tables.md
{ page "Keys of vfgen generate" "$note \`vfgen keys\`."; "$bin/vfgen" keys --md; } >generate.md
