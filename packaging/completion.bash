# Completion of granrun and vfgen: subcommands and options as their --help lists them, files otherwise.
_granrad() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} help
  if ((COMP_CWORD == 1)) && [[ $word != -* ]]; then
    help=$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z][a-z]*\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$help" -- "$word")
  elif [[ $word == -* ]]; then
    help=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE '(^|[ ,])--?[a-z][a-z-]*' | tr -d ' ,')
    mapfile -t COMPREPLY < <(compgen -W "$help" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _granrad granrun vfgen
