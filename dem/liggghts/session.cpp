#include "dem/liggghts/session.h"

#include <fmt/format.h>

#define OMPI_SKIP_MPICXX
#include <liggghts/atom.h>
#include <liggghts/atom_vec.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/fix.h>
#include <liggghts/lammps.h>
#include <liggghts/library.h>
#include <liggghts/modify.h>
#include <liggghts/update.h>
#include <mpi.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "dem/base/error.h"
#include "dem/liggghts/histories.h"
#include "dem/liggghts/refusal.h"
#include "dem/liggghts/stl_file.h"
#include "dem/liggghts/world.h"

namespace granrad::liggghts {

namespace {

/// Keeps std::cerr quiet: every instance after the first warns that its contact models exist already.
class Quiet {
 public:
  Quiet() : speaks_to_(std::cerr.rdbuf(nullptr)) {}
  ~Quiet() { std::cerr.rdbuf(speaks_to_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  std::streambuf* speaks_to_;
};

Vec3 vec3(const double* p) {
  return {p[0], p[1], p[2]};
}

void put(const Vec3& v, double* p) {
  for (int a = 0; a < 3; ++a) p[a] = v[a];
}

/// What one rank says of a sphere of its own.
struct SphereState {
  std::int32_t sphere, springs;  ///< index; how many springs it has
  Vec3 position_m, velocity_m_s, angular_velocity_rad_s;
};

}  // namespace

struct Session::Impl {
  void* handle = nullptr;
  LAMMPS_NS::LAMMPS* lmp = nullptr;
  std::vector<std::string> mesh_names;
  std::optional<Histories> histories;  ///< after the first run
  bool abandoned = false;
  std::vector<std::int32_t> atom_of;  ///< by sphere; -1: of another rank

  template <class F>
  void guarded(F action) {
    try {
      action();
    } catch (...) {
      abandoned = true;
      throw;
    }
  }
  template <class F>
  void set_up(const std::string& what, F action);
  void command(const std::string& line) { lammps_command(handle, line.c_str()); }
  bool owns(const Vec3& p) const;
  void create_atoms(const Spheres& spheres);
  void place(const Spheres& spheres);
  void read(Spheres& spheres);
};

Session::Session() : impl_(std::make_unique<Impl>()) {
  const World& world = World::started();
  const Quiet quiet;
  // It writes to its screen without asking whether it has one.
  std::string words[] = {"granrad", "-log", "none", "-screen", "/dev/null", "-echo", "none"};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  lammps_open(static_cast<int>(arguments.size()), arguments.data(), *static_cast<MPI_Comm*>(world.comm()),
              &impl_->handle);
  impl_->lmp = static_cast<LAMMPS_NS::LAMMPS*>(impl_->handle);
  // The layout of its classes is that of its headers.
  if (lammps_extract_global(impl_->handle, "nlocal") != &impl_->lmp->atom->nlocal)
    throw InputError(advised("dem.engine = \"liggghts\" (the library does not belong to its headers)",
                             "reinstall libliggghts-dev and configure again"));
}

Session::~Session() {
  if (impl_->handle && !impl_->abandoned) lammps_close(impl_->handle);
}

/// An action of the set-up; what LIGGGHTS refuses is the user's scene.
template <class F>
void Session::Impl::set_up(const std::string& what, F action) {
  try {
    guarded(action);
  } catch (const Refusal& refusal) {
    throw InputError(
        advised("dem.engine = \"liggghts\" (LIGGGHTS refuses '" + what + "': " + refusal.message + ")",
                "change the scene or use \"native\""));
  }
}

void Session::command(const std::string& line) {
  impl_->set_up(line, [&] { impl_->command(line); });
}

void Session::add_mesh(const std::string& name, const WallMesh& mesh, std::int32_t type) {
  const StlFile file(mesh.triangles);
  std::string line = fmt::format("fix {} all mesh/surface file \"{}\" type {}", name, file.path(), type);
  if (const Vec3& v = mesh.velocity_m_s; v != Vec3{})
    line += fmt::format(" surface_vel {:.17g} {:.17g} {:.17g}", v.x, v.y, v.z);
  command(line);
  impl_->mesh_names.push_back(name);
}

void Session::cut(const Parts& parts) {
  auto& comm = *impl_->lmp->comm;
  double* const split[] = {comm.xsplit, comm.ysplit, comm.zsplit};
  for (int a = 0; a < 3; ++a) {
    if (comm.procgrid[a] != parts.count[a])
      throw InputError(
          advised("dem.engine = \"liggghts\" (its ranks are not cut as asked)", "use libliggghts 3.8"));
    std::copy(parts.split[a].begin(), parts.split[a].end(), split[a]);
  }
  comm.uniform = 0;
  impl_->lmp->domain->set_local_box();
}

/// Whether a point lies in this rank's part of the domain; what lies outside the domain belongs to the part at its side.
bool Session::Impl::owns(const Vec3& p) const {
  const auto& domain = *lmp->domain;
  const auto& comm = *lmp->comm;
  for (int a = 0; a < 3; ++a) {
    const bool below = p[a] < domain.sublo[a] && comm.myloc[a] > 0;
    const bool beyond = p[a] >= domain.subhi[a] && comm.myloc[a] < comm.procgrid[a] - 1;
    if (below || beyond) return false;
  }
  return true;
}

/// Sphere k becomes the atom with tag k + 1, on its rank.
void Session::Impl::create_atoms(const Spheres& spheres) {
  auto& atom = *lmp->atom;
  atom.map_clear();
  atom.nlocal = atom.nghost = 0;
  atom_of.assign(spheres.position_m.size(), -1);
  for (std::size_t k = 0; k < spheres.position_m.size(); ++k) {
    if (!owns(spheres.position_m[k])) continue;
    double at[3];
    put(spheres.position_m[k], at);
    const int i = atom_of[k] = atom.nlocal;
    atom.avec->create_atom(spheres.type[k], at);
    atom.tag[i] = static_cast<int>(k) + 1;
    atom.radius[i] = spheres.radius_m[k];
    atom.density[i] = spheres.density_kg_m3[k];
    atom.rmass[i] = 4.0 / 3.0 * 3.14159265358979323846 * spheres.radius_m[k] * spheres.radius_m[k] *
                    spheres.radius_m[k] * spheres.density_kg_m3[k];
    put(spheres.velocity_m_s[k], atom.v[i]);
    put(spheres.angular_velocity_rad_s[k], atom.omega[i]);
    for (int n = 0; n < atom.nextra_grow; ++n) lmp->modify->fix[atom.extra_grow[n]]->set_arrays(i);
  }
  atom.natoms = static_cast<LAMMPS_NS::bigint>(spheres.position_m.size());
  atom.map_init();
  atom.map_set();
}

/// Where the domain grows to hold the spheres, ranks' parts move: they are dealt out anew then.
void Session::Impl::place(const Spheres& spheres) {
  create_atoms(spheres);
  if (World::started().count() == 1) return;
  const auto part = [&] { return std::pair(vec3(lmp->domain->sublo), vec3(lmp->domain->subhi)); };
  const auto before = part();
  lmp->domain->reset_box();
  if (!World::started().joined(std::vector<char>(before == part() ? 0 : 1)).empty()) create_atoms(spheres);
}

void Session::Impl::read(Spheres& spheres) {
  auto& atom = *lmp->atom;
  histories->collect();
  const std::size_t count = spheres.position_m.size();
  std::vector<SphereState> states;
  std::vector<Spring> springs;
  for (std::size_t k = 0; k < count; ++k) {
    const int i = atom.map(static_cast<int>(k) + 1);
    if (i < 0 || i >= atom.nlocal) continue;
    double unwrapped[3];
    lmp->domain->unmap(atom.x[i], atom.image[i], unwrapped);
    const std::size_t before = springs.size();
    histories->append(i, static_cast<std::int32_t>(k), springs);
    states.push_back({static_cast<std::int32_t>(k), static_cast<std::int32_t>(springs.size() - before),
                      vec3(unwrapped), vec3(atom.v[i]), vec3(atom.omega[i])});
  }
  states = World::started().joined(std::move(states));
  springs = World::started().joined(std::move(springs));
  if (states.size() != count)
    throw Refusal{std::to_string(count - states.size()) + " particles left its domain"};
  std::vector<std::size_t> begin(count + 1, 0);
  for (const SphereState& s : states)
    begin[static_cast<std::size_t>(s.sphere) + 1] = static_cast<std::size_t>(s.springs);
  for (std::size_t k = 0; k < count; ++k) begin[k + 1] += begin[k];
  spheres.springs.resize(springs.size());
  auto next = springs.begin();
  for (const SphereState& s : states) {
    const auto k = static_cast<std::size_t>(s.sphere);
    spheres.position_m[k] = s.position_m;
    spheres.velocity_m_s[k] = s.velocity_m_s;
    spheres.angular_velocity_rad_s[k] = s.angular_velocity_rad_s;
    std::copy_n(next, s.springs, spheres.springs.begin() + static_cast<std::ptrdiff_t>(begin[k]));
    next += s.springs;
  }
}

void Session::run(Spheres& spheres, std::int64_t steps) {
  Impl& impl = *impl_;
  try {
    impl.guarded([&] {
      impl.lmp->update->reset_timestep(LAMMPS_NS::bigint{0});  // schedules depend on the step
      impl.place(spheres);
      if (!impl.histories) {  // the first run makes them; spheres of all types must be there
        impl.set_up("run 0", [&] { impl.command("run 0 post no"); });
        impl.histories.emplace(*impl.lmp, impl.mesh_names);
        impl.place(spheres);
      }
      impl.histories->give(spheres.springs, impl.atom_of);
      impl.command("run " + std::to_string(steps) + " post no");
      impl.read(spheres);
    });
  } catch (const Refusal& refusal) {
    throw NumericalError(
        advised("LIGGGHTS stopped: " + refusal.message, "try a smaller step or engine = \"native\""));
  }
}

}  // namespace granrad::liggghts
