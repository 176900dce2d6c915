# Writes OUT with the version and the commit of SOURCE, when they changed since. The commit is only taken of a work tree
# whose top is SOURCE itself, never of a repository around an unpacked archive.
set(sha unknown)
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE
                ERROR_QUIET)
file(REAL_PATH ${SOURCE} source)
if(top)
  file(REAL_PATH ${top} top)
endif()
if(top STREQUAL source)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short HEAD OUTPUT_VARIABLE sha OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND sha -dirty)
  endif()
endif()
if(NOT sha)
  set(sha unknown)
endif()
set(text "#include \"dem/base/program.h\"\n\nnamespace granrad {\n
const char* program_version() {\n  return \"${VERSION}\";\n}
const char* program_git_sha() {\n  return \"${sha}\";\n}\n\n}  // namespace granrad\n")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${OUT} "${text}")
endif()
