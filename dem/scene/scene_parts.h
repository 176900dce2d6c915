#pragma once
#include "dem/scene/scene.h"

namespace granrad {

/// Pieces of read_scene; each reads its tables of the scene into `scene` and records problems in them.

/// [[remove]]. Precondition: dem.engine is read.
void read_removals(TomlTable root, Scene& scene);

/// [box], [walls.*], [[polygon]], [[mesh]] and [region]. Preconditions: materials and feed.kind are read;
/// `roles_required`: every wall must choose its role because radiation is on.
void read_geometry(TomlTable root, Scene& scene, bool roles_required);

/// What a wall is but its shape. `inherits`: what the table does not say stays as it is; else `role_required`.
/// Precondition: materials are read.
void read_wall_properties(TomlTable& table, Wall& wall, const Scene& scene, bool role_required,
                          bool inherits = false);

/// kind of [feed], which other parts depend on.
FeedSettings::Kind read_feed_kind(TomlTable feed);

/// files and between of [dem]. Preconditions: engine and feed.kind are read.
void read_replay(TomlTable& dem, Scene& scene);

/// The rest of [feed]. Preconditions: materials, particles and box are read.
void read_feed(TomlTable feed, Scene& scene);

}  // namespace granrad
