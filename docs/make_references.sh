#!/usr/bin/env bash
# make_references.sh BIN: writes the references that programs make of themselves.
set -euo pipefail
bin=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
page() { printf '# %s\n\n%s\n\n' "$1" "$2"; }
note='Plain numbers are SI; texts may carry units ("0.8 mm", "1.59 g/s"). Unknown keys are errors. This page is made by'
{ page "Scene keys" "$note \`granrun keys\`."; "$bin/granrun" keys --md; } >scene.md
{ page "Keys of studies" "$note \`granrun keys study\`. What they mean together: [study.md](study.md)."; "$bin/granrun" keys study --md; } >study_keys.md
{
  printf '# Commands\n\nWhat `granrun --help` and `vfgen --help` say, command by command. This page is made by them.\n'
  for program in granrun vfgen; do
    subs() { "$bin/$1" "${@:2}" --help | sed -n '/^Subcommands:/,$ s/^  \([a-z][a-z]*\) .*/\1/p'; }
    for command in "" $(subs $program); do
      # shellcheck disable=SC2086
      for below in "" $(subs $program $command | { [[ -n $command ]] && cat || true; }); do
        printf '\n## `%s`\n\n```text\n' "$(echo $program $command $below)"
        # shellcheck disable=SC2086
        "$bin/$program" $command $below --help
        printf '```\n'
      done
    done
  done
} >commands.md
{ page "Keys of correlation tables" "$note \`granrun keys table\`."; "$bin/granrun" keys table --md; } >tables.md
{ page "Keys of vfgen generate" "$note \`vfgen keys\`."; "$bin/vfgen" keys --md; } >generate.md
