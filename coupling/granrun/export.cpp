#include "coupling/granrun/export.h"

#include <fmt/core.h>

#include "coupling/simulation/case_folder.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/io/export_text.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace {

std::string text_of(const Bed& bed, const std::string& format) {
  return format == "vtp" ? vtp_text(bed) : format == "csv" ? csv_text(bed) : dump_text(bed);
}

}  // namespace

int export_case(const std::filesystem::path& where, const std::string& format, const RunOptions& options) {
  const CaseFolder folder(where);
  const auto frames = folder.frames();
  if (frames.empty())
    throw InputError(
        advised(fmt::format("{} (has no frames yet)", where.string()), "wait, or look into its history.csv"));
  Progress progress("export", static_cast<double>(frames.size()), options.quiet());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Bed bed = read_frame(frames[k].file).bed;
    auto name = frames[k].file.filename();
    write_text_file(folder.root() / "export" / name.replace_extension(format), text_of(bed, format));
    progress.update(static_cast<double>(k + 1));
  }
  progress.finish();
  if (!options.quiet()) fmt::print("{} frames in {}\n", frames.size(), (folder.root() / "export").string());
  return exit_ok;
}

}  // namespace granrad
