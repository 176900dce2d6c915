#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dem/engine.h"
#include "dem/scene/scene.h"

namespace granrad {

/// The flow solver LIGGGHTS 3.8 (Debian's libliggghts, GPL 2) behind the contract of the native engine: the
/// field's reference code on the same scene, to check the native engine or to trust its flow. The two share
/// no line. One thread a rank; optional in a build.
///
/// Model: `pair_style gran model hertz tangential history [rolling_friction cdt]`, the law of
/// dem/native/hertz_mindlin.h with the same mixing of materials; velocity Verlet (`nve/sphere`), of first order in
/// the step once contacts dissipate; standing walls as triangle meshes (`mesh/surface`); gravity, periodic
/// boundaries, spheres of any radii and materials.
///
/// Under mpirun (dem/ranks) all ranks move the spheres together: each takes those in its part of the domain and tells all
/// ranks what became of them and of their springs. Parts are cut at each advance so that each holds about as many spheres
/// (dem/liggghts/parts.h). Results on different numbers of ranks differ by the order of sums.
///
/// A function of the Bed: each advance makes a rank's spheres and springs anew from the Bed in the order of the ids, so
/// feeds may change the Bed at will, parts may move, and nothing is left of how spheres came to their ranks. That takes the
/// time of some three DEM steps of a rank's own spheres, most of it LIGGGHTS' set-up of a run, and of one step of all
/// spheres for what ranks tell each other. A resumed run continues bit for bit where it is cut
/// as the first was, as granrun does. Cut elsewhere it differs by as much as the step's error: LIGGGHTS
/// starts from forces at whole-step velocities, where inside a run it uses those of half a step before.
///
/// Wall springs are stored under the number of their face in the order of walls and triangles: for polygons
/// the native engine's, so either goes on from a frame of the other; springs at meshes, edges and corners may
/// start anew there. Faces within 0.26 degrees of each other count as one plane.
/// It does not record touches: heat sees contacts as they stand when asked, collisions shorter than that by chance.
/// LIGGGHTS detects no tunnelling and no deep overlap. Its errors arrive as exceptions; it and MPI stay
/// silent. MPI starts with the first engine and ends with the process.
///
/// advance throws InputError for walls and materials that LIGGGHTS refuses, NumericalError when it stops.
std::unique_ptr<Engine> make_liggghts_engine(const Vec3& gravity_m_s2, double step_s);

/// What keeps LIGGGHTS from running this scene, each with its key and advice; empty: nothing. A build without
/// it; a restitution of 0.05 or less; walls with materials of several Young's moduli or Poisson ratios (its
/// walls have one of each, ours are of each particle's own material).
std::vector<std::string> liggghts_problems(const Scene& scene);

}  // namespace granrad
