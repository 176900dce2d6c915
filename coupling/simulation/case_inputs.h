#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/base/toml/toml_reader.h"

namespace granrad {

/// A file that a scene names.
struct InputFile {
  std::string key;             ///< "mesh[0].file"
  std::filesystem::path file;  ///< where it was found
  std::string stored_as;       ///< its place in the folder of a case: "inputs/hopper.stl"
  std::uint64_t hash = 0;      ///< of its content
};

/// Every file the document has named so far. Throws IoError when one cannot be read.
std::vector<InputFile> input_files(const TomlDocument& document);

/// The document with its files where a case keeps its copies: the scene.toml of a case, which runs anywhere.
std::string portable_text(const TomlDocument& document, const std::vector<InputFile>& inputs);

/// The document without what a continued run may change (its end, its intervals, its DEM step), its files by
/// their content: two scenes with the same text can lead on from the same frame.
std::string identity_text(const TomlDocument& document, const std::vector<InputFile>& inputs);

/// Copies the inputs below `folder`; one that is there already with the same content stays. Throws IoError.
void copy_inputs(const std::vector<InputFile>& inputs, const std::filesystem::path& folder);

}  // namespace granrad
