# Writes OUT, a C++ source that defines granrad::page_asset_NAME of each FILES entry "NAME=path".
string(REPLACE "|" ";" FILES "${FILES}")
set(text "// Made of dem/page/assets.\n#include \"dem/page/page_assets.h\"\n\nnamespace granrad {\n\n")
foreach(entry ${FILES})
  string(REGEX MATCH "^([^=]+)=(.*)$" matched "${entry}")
  set(name ${CMAKE_MATCH_1})
  file(READ ${CMAKE_MATCH_2} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND text "static const unsigned char bytes_${name}[] = {${bytes}0};\n"
    "std::string_view page_asset_${name}() {\n"
    "  return {reinterpret_cast<const char*>(bytes_${name}), sizeof(bytes_${name}) - 1};\n}\n\n")
endforeach()
string(APPEND text "}  // namespace granrad\n")
file(WRITE ${OUT} "${text}")
