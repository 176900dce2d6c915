#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coupling/heat/conduction.h"
#include "coupling/simulation/case_inputs.h"
#include "coupling/simulation/radiation_source.h"
#include "dem/base/toml/toml_reader.h"
#include "dem/scene/scene.h"

namespace granrad {

/// [output]
struct OutputSettings {
  double every_s = 0, frames_every_s = 0;
  std::optional<double> average_from_s{};  ///< means start here; absent: where the history becomes stationary
};

/// [validate]: what `granrun validate` compares. Absent: a choice by the scene (see compare_sources.h).
struct ValidateSettings {
  std::vector<std::filesystem::path> snapshots;  ///< [[validate.snapshot]] file; none: the bed of the scene
  std::optional<RadiationSettings> reference;    ///< [validate.reference]
  std::vector<RadiationSettings> compared;       ///< [[validate.compare]]
  std::vector<double> times_s;                   ///< rows of validation.csv
};

/// The heat part of what the user wrote: SI, checked.
struct HeatScene {
  ConductionSettings conduction;         ///< [conduction], and [gas]: absent, no lenses
  bool modulus_exponent_chosen = false;  ///< by the scene, not by default
  int conduction_every_steps = 0;  ///< DEM steps between conduction updates; 0: chosen (see time_plan.h)
  RadiationSettings radiation;
  std::optional<double> surroundings_K;  ///< [surroundings]: of what rays meet beyond all walls
  OutputSettings output;
  ValidateSettings validate;
};

/// Reads [gas], [conduction], [radiation], [surroundings], [output], [validate] and checks them against the flow part;
/// problems go to the document.
HeatScene read_heat_scene(TomlDocument& document, const Scene& scene);

/// What the user wrote, all of it.
struct Case {
  Scene flow;
  HeatScene heat;
  std::string effective_text;      ///< the document in force, as TOML
  std::vector<InputFile> inputs;   ///< every file it names
  std::string portable_text;       ///< it, with its files where a case keeps their copies
  std::string identity;            ///< what its frames depend on (see identity_text)
  std::string text_with_defaults;  ///< as effective_text, with the defaults in force as comments
};

/// Reads a scene file without the keys `removed` and with `overrides` ("key=value"). Throws InputError with
/// every problem, IoError.
Case read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides,
               const std::vector<std::string>& removed = {});

}  // namespace granrad
