#include "tests/source_dir.h"

std::string granrad::source_dir() {
  return GRANRAD_SOURCE_DIR;
}
