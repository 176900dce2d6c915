#pragma once
#include "dem/bed/near_pairs.h"
#include "dem/native/contact_lists.h"

namespace granrad::native {

/// The pairs of near_pairs(bed, max_gap_m), bit for bit, from lists that are complete for that gap. `bed` is
/// the one the rows hold.
std::vector<NearPair> near_particles(const Bed& bed, const Rows& rows, const ContactLists& lists,
                                     const Kernels& kernels, double max_gap_m);

/// The particles that may be that near to a wall, or to an image of one across a periodic border.
std::vector<std::int32_t> particles_at_walls(const ContactLists& lists, const Rows& rows);

/// Its walls likewise. Not for periodic beds, where walls are met at images.
std::vector<NearWall> near_walls(const ContactLists& lists, const Rows& rows, const WallSurface& surface,
                                 double max_gap_m);

}  // namespace granrad::native
