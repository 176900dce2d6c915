#pragma once
#include "coupling/study/study.h"
#include "dem/base/toml/toml_reader.h"

namespace granrad {

/// What a study makes of its cases: [[column]], [[fit]], [[figure]] and [claims].
void read_outputs(TomlTable& root, Study& study);

}  // namespace granrad
