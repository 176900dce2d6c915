#pragma once
#include <fmt/format.h>
#include <fmt/os.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <regex>
#include <string>

#include "dem/bed/bed.h"

// The same beds run by Debian's LIGGGHTS and LAMMPS, one process each.
namespace granrad::bench {

inline bool installed(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

/// LAMMPS data file of a bed of equal spheres.
inline void write_data(const std::filesystem::path& file, const Bed& bed) {
  auto out = fmt::output_file(file.string());
  const auto &low = bed.box.min, &high = bed.box.max;
  out.print("bed\n\n{} atoms\n1 atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n{} {} zlo zhi\n\nAtoms\n\n",
            bed.size(), low.x, high.x, low.y, high.y, low.z, high.z);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3& p = bed.position_m[i];
    out.print("{} 1 {} {} {} {} {}\n", i + 1, 2 * bed.radius_m[i], bed.materials[0].density_kg_m3, p.x, p.y,
              p.z);
  }
  out.print("\nVelocities\n\n");
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3 &v = bed.velocity_m_s[i], &w = bed.angular_velocity_rad_s[i];
    out.print("{} {} {} {} {} {} {}\n", i + 1, v.x, v.y, v.z, w.x, w.y, w.z);
  }
}

inline void write_stl(const std::filesystem::path& file, const Wall& wall) {
  auto out = fmt::output_file(file.string());
  out.print("solid wall\n");
  for (const auto& t : wall.triangles) {
    const Vec3 &a = wall.vertices[t[0]], &b = wall.vertices[t[1]], &c = wall.vertices[t[2]];
    const Vec3 n = normalized(cross(b - a, c - a));
    out.print("facet normal {} {} {}\nouter loop\n", n.x, n.y, n.z);
    for (const Vec3& v : {a, b, c}) out.print("vertex {:.9e} {:.9e} {:.9e}\n", v.x, v.y, v.z);
    out.print("endloop\nendfacet\n");
  }
  out.print("endsolid wall\n");
}

/// Seconds of the last run of a log ("Loop time of X on ...").
inline std::optional<double> loop_seconds(const std::string& command) {
  FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (!pipe) return {};
  std::optional<double> seconds;
  std::array<char, 4096> line;
  const std::regex pattern("Loop time of ([0-9.eE+-]+)");
  std::cmatch match;
  while (std::fgets(line.data(), line.size(), pipe))
    if (std::regex_search(line.data(), match, pattern)) seconds = std::stod(match[1]);
  return pclose(pipe) == 0 ? seconds : std::nullopt;
}

/// Million particle-steps per second of a peer (liggghts or lmp) on a stored deck, which reads bed12k.data
/// beside it.
inline std::optional<double> run_stored(const std::string& peer, const std::filesystem::path& deck,
                                        const std::filesystem::path& folder, const Bed& bed, int steps) {
  const std::string program = peer == "lammps" ? "lmp" : peer;
  if (!installed(program)) return {};
  const auto seconds = loop_seconds(
      fmt::format("cd '{}' && {} -in '{}' -log none -var data '{}' -var nrun {}", folder.string(), program,
                  deck.string(), (deck.parent_path() / "bed12k.data").string(), steps));
  if (!seconds) return {};
  return double(bed.size()) * steps / *seconds * 1e-6;
}

/// Million particle-steps per second of LIGGGHTS, or nothing where it is not installed or fails.
inline std::optional<double> run_liggghts(const std::filesystem::path& folder, const Bed& bed,
                                          const Vec3& gravity, int warm_up, int steps) {
  if (!installed("liggghts")) return {};
  write_data(folder / "bed.data", bed);
  {
    auto deck = fmt::output_file((folder / "in.lig").string());
    const auto edge = [&](int a) { return bed.periodic[a] ? 'p' : 'f'; };
    deck.print(
        "atom_style granular\natom_modify map array\nboundary {} {} {}\nnewton off\ncommunicate single vel "
        "yes\n"
        "units si\nprocessors 1 1 1\nread_data bed.data\nneighbor 0.0002 bin\nneigh_modify delay 0 every 1 "
        "check yes\n",
        edge(0), edge(1), edge(2));
    const auto& m = bed.materials[0];
    deck.print(
        "fix m1 all property/global youngsModulus peratomtype {}\nfix m2 all property/global poissonsRatio "
        "peratomtype {}\n"
        "fix m3 all property/global coefficientRestitution peratomtypepair 1 {}\n"
        "fix m4 all property/global coefficientFriction peratomtypepair 1 {}\n",
        m.youngs_modulus_Pa, m.poisson_ratio, m.restitution, m.friction);
    deck.print("pair_style gran model hertz tangential history\npair_coeff * *\ntimestep 1e-5\n");
    if (norm(gravity) > 0)
      deck.print("fix gravi all gravity {} vector {} {} {}\n", norm(gravity), gravity.x, gravity.y,
                 gravity.z);
    std::string meshes;
    int count = 0;
    for (const auto& w : bed.walls) {
      if (w.triangles.empty()) continue;
      write_stl(folder / (w.name + ".stl"), w);
      deck.print("fix {0} all mesh/surface file {0}.stl type 1\n", w.name);
      meshes += " " + w.name, ++count;
    }
    if (count > 0)
      deck.print("fix walls all wall/gran model hertz tangential history mesh n_meshes {} meshes{}\n", count,
                 meshes);
    else if (!bed.walls.empty())
      deck.print("fix zw all wall/gran model hertz tangential history primitive type 1 zplane 0.0\n");
    deck.print("fix integr all nve/sphere\nthermo {1}\nthermo_modify lost ignore norm no\nrun {0}\nrun {1}\n",
               warm_up, steps);
  }
  const auto seconds = loop_seconds(fmt::format("cd '{}' && liggghts -in in.lig", folder.string()));
  if (!seconds) return {};
  return double(bed.size()) * steps / *seconds * 1e-6;
}

/// The same by LAMMPS (`pair_style granular`, tangential Mindlin with history); beds with a floor only.
inline std::optional<double> run_lammps(const std::filesystem::path& folder, const Bed& bed, int warm_up,
                                        int steps) {
  if (!installed("lmp")) return {};
  write_data(folder / "bed.data", bed);
  {
    auto deck = fmt::output_file((folder / "in.lmp").string());
    deck.print(
        "units si\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\nread_data bed.data\n"
        "neighbor 0.0002 bin\nneigh_modify delay 0 every 1 check yes\npair_style granular\n"
        "pair_coeff * * hertz/material 5e6 0.45 0.23 tangential mindlin NULL 1.0 0.4 damping tsuji\n"
        "fix zw all wall/gran granular hertz/material 5e6 0.45 0.23 tangential mindlin NULL 1.0 0.4 damping "
        "tsuji zplane 0.0 NULL\ntimestep 1e-5\nfix gravi all gravity 9.81 vector 0.0 0.0 -1.0\n"
        "fix integr all nve/sphere\nthermo {1}\nrun {0}\nrun {1}\n",
        warm_up, steps);
  }
  const auto seconds = loop_seconds(fmt::format("cd '{}' && lmp -in in.lmp -log none", folder.string()));
  if (!seconds) return {};
  return double(bed.size()) * steps / *seconds * 1e-6;
}

}  // namespace granrad::bench
