#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dem/base/toml/toml_reader.h"
#include "dem/bed/bed.h"
#include "dem/bed/material.h"
#include "dem/bed/wall.h"

namespace granrad {

/// How particles come in and go (see dem/feed/feed.h).
struct FeedSettings {
  enum class Kind { none, plug, hopper };
  Kind kind = Kind::none;
  double solid_fraction = 0;  ///< plug: target in the channel
  double mass_flow_kg_s = 0;  ///< plug: rho phi A v; hopper: of the refill at most, when > 0
  double velocity_m_s = 0;    ///< plug: downward speed (towards z_min)
  double transverse_velocity_std_m_s = 0;
  bool start_filled = true;         ///< plug: channel full at time 0; false: empty
  std::int64_t particle_count = 0;  ///< hopper: particles kept in the system, or poured in all
  double rate_1_s = 0;              ///< hopper, > 0: poured at this rate from the start, into what is there
  Box fill_region{};          ///< hopper: where particles are inserted ([feed.fill_region] min_m, max_m)
  bool refill = true;         ///< hopper: what left comes back cold at the top; false: one batch
  double remove_below_m = 0;  ///< hopper: particles whose centre falls below this z leave
  std::uint64_t seed = 1;
};

enum class EngineKind { native, liggghts, none, replay };
inline constexpr ChoiceNames<EngineKind::replay> engine_names;

/// Whether the flow is computed from forces: its step has limits.
inline bool computes_forces(EngineKind engine) {
  return engine == EngineKind::native || engine == EngineKind::liggghts;
}

/// A recorded flow (see dem/engine_replay.h).
struct ReplaySettings {
  std::vector<std::filesystem::path> files;  ///< in time
  bool interpolated = false;
};

/// Of the contact law between particles: double, or single with all else in double (dem/engine_native.h).
enum class Precision { full, mixed };

/// The flow part of what the user wrote: SI, checked, complete. Each room reads its own part from the same
/// document (heat: coupling/simulation/heat_scene.h).
struct Scene {
  std::string name;
  double end_time_s = 0;
  Vec3 gravity_m_s2{};
  std::vector<Material> materials;  ///< [material] first, then [[materials]] by name
  Box box;
  std::vector<Wall> walls;         ///< the box's six in the order x_min..z_max, then polygons, then meshes
  std::size_t box_wall_count = 0;  ///< how many of them, in front, are faces of the box
  std::vector<std::string> notes;  ///< what was done to the walls (see cover_walls)
  std::array<bool, 3> periodic{};
  std::vector<Box> removals;            ///< [[remove]]: particles whose centre comes into one of these leave
  Box region;                           ///< the heat-transfer region
  double particle_diameter_m = 0;       ///< of the feed's particles; with a file, its mean unless given
  double particle_temperature_K = 300;  ///< of the feed's particles, and of a file without temperatures
  std::filesystem::path particle_file;  ///< empty: particles come from the feed
  std::vector<std::string> particle_types;  ///< materials of types 1, 2, ... of a dump; empty: in their order
  FeedSettings feed;
  ReplaySettings replay;
  EngineKind engine = EngineKind::native;
  Precision precision = Precision::full;
  double step_s = 0;  ///< DEM step; 0: the largest allowed by the step limits
};

/// Reads and checks the flow part; problems go to the document (call finish() after every room has read).
/// Derived, never asked for: one of a plug's solid fraction, mass flow and speed from the other two (mass
/// flow = rho phi A v, A the cross-section of the box); a hopper's particle_count from mass_kg; the box
/// around polygons and meshes; the region (the box); the diameter from a particle file; wall emissivity from
/// the material.
Scene read_scene(TomlDocument& document);

struct Snapshot;
/// Materials and types of a snapshot become those of the scene, temperatures it has none of particles.temperature_K.
/// Throws InputError when the scene has no such material.
void take_into_scene(Snapshot& snapshot, const Scene& scene);

/// The Bed at time 0 without a feed: walls and materials of the scene, particles from its file if any. A
/// frame gives velocities, temperatures and contacts too (those with walls only if its walls are the
/// scene's). Throws InputError when a centre lies behind a contact wall of the box (count and first ten ids),
/// when two particles overlap by more than a tenth of the smaller radius, or when the file names a material
/// the scene lacks.
/// `left_out`: particles behind walls of the box are left out and counted; without it they are refused.
Bed initial_bed(const Scene& scene, std::size_t* left_out = nullptr);

}  // namespace granrad
