#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dem/base/toml/toml_reader.h"
#include "dem/scene/scene.h"
#include "raytrace/exchange.h"
#include "raytrace/exchange_source.h"

namespace granrad {

enum class RadiationKind { none, paths, embree, lines, shading, correlation };
inline constexpr ChoiceNames<RadiationKind::correlation> radiation_names;
inline const char* to_string(RadiationKind kind) {
  return radiation_names.of(kind);
}

/// [radiation], and each source of [validate].
struct RadiationSettings {
  RadiationKind kind = RadiationKind::none;
  std::filesystem::path table;  ///< correlation only
  bool traced_walls = false;    ///< correlation only: rows of the walls by rays, not by the table
  double rays =
      0;  ///< paths: walks per update, 0: as many as `error` needs; embree, lines, traced walls: rays per particle
  double error = 0;    ///< paths with rays chosen: relative standard error of the mean wall heat over the run
  double every_s = 0;  ///< 0: chosen (see radiation_interval_s)
  Closure closure = Closure::reciprocal;
  int order = 0;  ///< lines only: of the spherical harmonics of each sphere's radiosity; 0: one radiosity
  bool patches =
      true;  ///< embree, lines, shading, traced wall rows: walls that reflect are cut into patches, one radiosity each
  std::uint64_t seed = 1;
};

/// A source of radiative exchange: [radiation], or one that is compared. Problems are recorded in the table.
RadiationSettings read_source(TomlTable table, const Scene& scene, RadiationKind otherwise);

/// [radiation]: a source, and how often it is asked.
RadiationSettings read_radiation(TomlTable table, const Scene& scene);

/// The exchange source the settings ask for; null for none. A correlation table is used at the solid
/// fractions of each enclosure it meets. Throws InputError, IoError (table).
std::unique_ptr<ExchangeSource> make_radiation_source(const RadiationSettings& settings, const Scene& scene,
                                                      int threads);

/// State of every surface of an enclosure of `bed` whose particles have the temperatures given (by particle);
/// the surroundings are black.
RadiativeState radiative_state(const Bed& bed, const std::vector<double>& temperature_K,
                               const Enclosure& enclosure, double surroundings_K);

/// One line for people: "paths, 10000 walks per update".
std::string describe(const RadiationSettings& settings);

}  // namespace granrad
