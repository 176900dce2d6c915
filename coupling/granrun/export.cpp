#include "coupling/granrun/export.h"

#include <fmt/core.h>

#include "coupling/simulation/case_folder.h"
#include "dem/base/error.h"
#include "dem/base/files/npz_file.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/bed/columns.h"
#include "dem/io/export_text.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace {

void write_npz(Bed bed, const std::filesystem::path& file) {
  for (Vec3& p : bed.position_m) p = wrapped_into_box(bed, p);
  const std::vector<Vec3> box = {bed.box.min, bed.box.max};
  const std::vector<std::int32_t> periodic = {bed.periodic[0], bed.periodic[1], bed.periodic[2]};
  NpzWriter npz;
  npz.add_scalar("time_s", bed.time_s);
  npz.add_scalar("step", bed.step);
  npz.add("box_m", box);
  npz.add("periodic", periodic);
  for_each_column([&](const auto& column) { npz.add(column.name, bed.*column.values); });
  npz.write(file);
}

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
    const auto file = folder.root() / "export" / name.replace_extension(format);
    if (format == "npz")
      write_npz(bed, file);
    else
      write_text_file(file, text_of(bed, format));
    progress.update(static_cast<double>(k + 1));
  }
  progress.finish();
  if (!options.quiet()) fmt::print("{} frames in {}\n", frames.size(), (folder.root() / "export").string());
  return exit_ok;
}

}  // namespace granrad
