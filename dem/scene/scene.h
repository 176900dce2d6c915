#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dem/scene/bed.h"
#include "dem/scene/material.h"
#include "dem/scene/toml_reader.h"
#include "dem/scene/wall.h"

namespace granrad {

/// How particles come in and go (see dem/feed.h).
struct FeedSettings {
  enum class Kind { none, plug, hopper };
  Kind kind = Kind::none;
  double solid_fraction = 0;       ///< plug: target in the channel
  double mass_flow_kg_s = 0;       ///< plug: rho phi A v; hopper: refill rate when > 0
  double velocity_m_s = 0;         ///< plug: downward speed (towards z_min)
  double transverse_velocity_std_m_s = 0;
  bool start_filled = true;        ///< plug: channel full at time 0; false: empty
  std::int64_t particle_count = 0; ///< hopper: particles kept in the system
  Box fill_region{};               ///< hopper: where particles are inserted
  double remove_below_m = 0;       ///< hopper: particles whose centre falls below this z leave
  std::uint64_t seed = 1;
};

enum class EngineKind { native, liggghts, none };

/// The flow part of what the user wrote: SI, checked, complete. Each room reads its own part from the same
/// document (heat: coupling/heat_scene.h).
struct Scene {
  std::string name;
  double end_time_s = 0;
  Vec3 gravity_m_s2{};
  std::vector<Material> materials;  ///< [material] first, then [[materials]] by name
  Box box;
  std::vector<Wall> walls;  ///< the box's six in the order x_min..z_max, then polygons, then meshes
  std::array<bool, 3> periodic{};
  Box region;  ///< the heat-transfer region
  double particle_diameter_m = 0;
  double particle_temperature_K = 300;
  std::filesystem::path particle_file;  ///< empty: particles come from the feed
  FeedSettings feed;
  EngineKind engine = EngineKind::native;
  double step_s = 0;  ///< DEM step; 0: the largest allowed by the step limits
};

/// Reads and checks the flow part; problems go to the document (call finish() after every room has read).
Scene read_scene(TomlDocument& document);

/// The Bed at time 0 without a feed: walls and materials of the scene, particles from its file if any.
Bed initial_bed(const Scene& scene);

}  // namespace granrad
