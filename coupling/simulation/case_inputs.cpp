#include "coupling/simulation/case_inputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

/// What `--resume` may find changed; the rest decides what the frames of a case mean.
const char* const free_to_change[] = {"scene.end_time_s",       "dem.step_s",           "radiation.every_s",
                                      "conduction.every_steps", "radiation.rays",       "output.every_s",
                                      "output.frames_every_s",  "output.average_from_s"};

/// The name of the file below inputs/, numbered where another file has it already.
std::string place_for(const InputFile& wanted, const std::vector<InputFile>& others) {
  for (int number = 1;; ++number) {
    const fs::path name = wanted.file.filename();
    const std::string place =
        number == 1 ? fmt::format("inputs/{}", name.string())
                    : fmt::format("inputs/{}_{}{}", name.stem().string(), number, name.extension().string());
    const bool taken = std::any_of(others.begin(), others.end(), [&](const InputFile& other) {
      return other.stored_as == place && other.hash != wanted.hash;
    });
    if (!taken) return place;
  }
}

}  // namespace

std::vector<InputFile> input_files(const TomlDocument& document) {
  std::vector<InputFile> inputs;
  for (const auto& [key, file] : document.files()) {
    InputFile input{key, file, "", text_hash(read_text_file(file))};
    input.stored_as = place_for(input, inputs);
    inputs.push_back(input);
  }
  return inputs;
}

std::string portable_text(const TomlDocument& document, const std::vector<InputFile>& inputs) {
  std::map<std::string, std::string> texts;
  for (const auto& input : inputs) texts[input.key] = input.stored_as;
  for (const auto& [key, pattern] : document.patterns())
    texts[key] = pattern.string();  // recordings stay in place
  return document.effective_text(texts);
}

std::string identity_text(const TomlDocument& document, const std::vector<InputFile>& inputs) {
  std::map<std::string, std::string> texts;
  for (const auto& input : inputs) texts[input.key] = fmt::format("{:016x}", input.hash);
  for (const auto& [key, pattern] : document.patterns()) texts[key] = pattern.string();
  auto identity = TomlDocument::from_string(document.effective_text(texts), "scene");
  for (const char* key : free_to_change) identity.override_value(fmt::format("{}=1", key));
  return identity.effective_text();
}

void copy_inputs(const std::vector<InputFile>& inputs, const fs::path& folder) {
  for (const auto& input : inputs) {
    const fs::path place = folder / input.stored_as;
    if (fs::is_regular_file(place) && text_hash(read_text_file(place)) == input.hash) continue;
    write_text_file(place, read_text_file(input.file));
  }
}

}  // namespace granrad
