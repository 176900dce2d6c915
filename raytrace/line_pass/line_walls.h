#pragma once
#include <string>
#include <vector>

#include "raytrace/line_pass/line_scene.h"

namespace granrad {

/// What walls must be for lines: planar, closed where nothing repeats, around a convex space.

/// Problems that make the enclosure unfit before any geometry can be judged.
std::vector<std::string> shape_problems(const Enclosure& e);

/// The faces of the walls from `middle`, with corners closer than `tolerance` made one.
std::vector<LineScene::Face> faces_about(const Enclosure& e, const Vec3& middle, double tolerance);

/// Every directed edge has its reverse exactly once.
bool edges_close(const std::vector<LineScene::Face>& faces);
/// The same where edges on opposite borders of the box are one.
bool edges_close_periodically(const std::vector<LineScene::Face>& faces, const Vec3& period,
                              double tolerance);

/// Whether the walls close the directions that are not periodic.
bool holds_volume(const Enclosure& e);

std::vector<std::string> convexity_problems(const Enclosure& e, const std::vector<LineScene::Face>& faces,
                                            double tolerance);

}  // namespace granrad
