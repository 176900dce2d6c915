#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "raytrace/enclosure.h"

namespace granrad {

/// What a few thousand rays tell about an enclosure before anything is computed with it.
struct EnclosureCheck {
  /// Why it cannot be computed right: backs of walls are seen (triangles turned or missing, plates of one
  /// side, bodies that reach into each other), particles are outside closed walls. Each with advice.
  std::vector<std::string> problems;
  std::vector<std::string> notes;  ///< what is probably a mistake, but can be computed
  std::int64_t rays = 0;
  std::int64_t open = 0;                    ///< of them reach the surroundings
  std::string leaves_most;                  ///< the surface that sends most of those
  std::vector<std::int64_t> fronts, backs;  ///< by wall: where rays from particles met it
};

/// Sends probe rays from every wall and up to 2000 particles. The same answer for every source, whatever it
/// traces with later. `id`: of the particles of the Bed, for messages; empty: their numbers.
EnclosureCheck check_enclosure(const Enclosure& enclosure, const std::vector<std::int64_t>& id = {});

/// Turns walls whose backs alone are seen from the particles; one note for each. Meshes as other programs
/// write them often face away from the bed.
std::vector<std::string> turn_walls_to_particles(std::vector<Wall>& walls, const EnclosureCheck& check,
                                                 const Enclosure& enclosure);

/// Turns meshes of a bed that show the particles nearly nothing but their back, as hoppers from CAD do whose normals
/// point out of the vessel, and says so. Bodies with the particles around them stay. Nothing is turned when the
/// enclosure would not be sound afterwards, nor in a bed without particles.
std::vector<std::string> turn_meshes_to_particles(Bed& bed, const Box& region);

}  // namespace granrad
