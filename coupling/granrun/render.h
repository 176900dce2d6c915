#pragma once
#include <filesystem>

#include "coupling/granrun/run_options.h"
#include "dem/bed/bed.h"
#include "dem/page/html_report.h"

namespace granrad {

/// A bed as pages and pictures show it: coloured by temperature, then by radiative flux where there is any.
BedPicture bed_picture(const Bed& bed);

/// granrun render: the last frame of a case as FILE.png, or all its frames as FILE.mp4 (25 a second, by ffmpeg). One scale of
/// colours for all frames; needs no screen. Throws InputError (another ending, no frames), IoError (no ffmpeg, file).
int render_case(const std::filesystem::path& folder, const std::filesystem::path& file,
                const RunOptions& options);

}  // namespace granrad
