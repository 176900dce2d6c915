#include "dem/liggghts/session.h"

#include <fmt/format.h>

#define OMPI_SKIP_MPICXX
#include <liggghts/atom.h>
#include <liggghts/atom_vec.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/error.h>
#include <liggghts/fix.h>
#include <liggghts/fix_contact_history.h>
#include <liggghts/fix_contact_history_mesh.h>
#include <liggghts/fix_mesh_surface.h>
#include <liggghts/force.h>
#include <liggghts/lammps.h>
#include <liggghts/library.h>
#include <liggghts/modify.h>
#include <liggghts/pair.h>
#include <liggghts/update.h>
#include <mpi.h>

#include <algorithm>
#include <iostream>
#include <limits>

#include "dem/base/error.h"
#include "dem/liggghts/stl_file.h"

namespace {

/// What LIGGGHTS says when it gives up.
struct Refusal {
  std::string message;
};

}  // namespace

// LIGGGHTS calls its error functions through the dynamic linker, which takes these before its own: an error
// becomes an exception in place of exit() or MPI_Abort().
namespace LAMMPS_NS {

void Error::all(const char*, int, const char* text) {
  throw Refusal{text};
}
void Error::one(const char*, int, const char* text) {
  throw Refusal{text};
}
void Error::cg(const char*, int, const char* text) {
  throw Refusal{text};
}
void Error::universe_all(const char*, int, const char* text) {
  throw Refusal{text};
}
void Error::universe_one(const char*, int, const char* text) {
  throw Refusal{text};
}
void Error::fix_error(const char*, int, Fix* fix, const char* text) {
  throw Refusal{std::string("fix ") + fix->id + ": " + text};
}
void Error::fix_error(const char*, int, Fix* fix, const char* style, const char* text) {
  throw Refusal{std::string("fix ") + fix->id + " (" + style + "): " + text};
}
void Error::compute_error(const char*, int, Compute*, const char* text) {
  throw Refusal{text};
}

}  // namespace LAMMPS_NS

namespace granrad::liggghts {
namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::FixContactHistory;
using LAMMPS_NS::FixMeshSurface;

/// MPI from the first session to the end of the process. Where the program has joined its ranks, MPI runs already and
/// all ranks move the spheres together; else this process is alone.
class Mpi {
 public:
  static const Mpi& started() {
    static const Mpi mpi;
    return mpi;
  }
  MPI_Comm comm() const { return comm_; }
  int count() const { return count_; }

  /// The values of all ranks in their order, at every rank.
  template <class T>
  std::vector<T> joined(const std::vector<T>& own) const {
    if (count_ == 1) return own;
    const auto bytes = static_cast<std::int64_t>(own.size() * sizeof(T));
    std::vector<std::int64_t> of_rank(static_cast<std::size_t>(count_));
    MPI_Allgather(&bytes, 1, MPI_INT64_T, of_rank.data(), 1, MPI_INT64_T, comm_);
    std::int64_t total = 0;
    std::vector<int> begin, size;
    for (const std::int64_t b : of_rank) {
      begin.push_back(static_cast<int>(total)), size.push_back(static_cast<int>(b));
      total += b;
    }
    if (total > std::numeric_limits<int>::max()) throw Refusal{"more spheres than MPI gathers at once"};
    std::vector<T> all(static_cast<std::size_t>(total) / sizeof(T));
    MPI_Allgatherv(own.data(), static_cast<int>(bytes), MPI_BYTE, all.data(), size.data(), begin.data(),
                   MPI_BYTE, comm_);
    return all;
  }

 private:
  Mpi() {
    int running = 0;
    MPI_Initialized(&running);
    if (!running) MPI_Init(nullptr, nullptr);
    owner_ = !running;
    MPI_Comm_dup(running ? MPI_COMM_WORLD : MPI_COMM_SELF, &comm_);
    MPI_Comm_size(comm_, &count_);
  }
  ~Mpi() {
    int finished = 0;
    MPI_Finalized(&finished);
    if (owner_ && !finished) MPI_Finalize();
  }
  bool owner_ = false;
  MPI_Comm comm_ = MPI_COMM_NULL;
  int count_ = 1;
};

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

struct MeshFixes {
  FixContactHistory* history;
  Fix* neighbours;  ///< per sphere: for how many triangles the history has room
};

Vec3 vec3(const double* p) {
  return {p[0], p[1], p[2]};
}

void put(const Vec3& v, double* p) {
  for (int a = 0; a < 3; ++a) p[a] = v[a];
}

/// The springs of one sphere as a history fix packs them: count, then (partner, displacement) each.
class PackedSprings {
 public:
  void clear() { buffer_.assign(1, 0.0), count_ = 0; }
  void add(std::int32_t partner, const Vec3& s) {
    buffer_.push_back(Fix::ubuf(partner).d);
    for (int a = 0; a < 3; ++a) buffer_.push_back(s[a]);
    ++count_;
  }
  int count() const { return count_; }
  void unpack_into(FixContactHistory& fix, int atom) {
    buffer_[0] = Fix::ubuf(count_).d;
    fix.unpack_exchange(atom, buffer_.data());
  }
  void pack_from(FixContactHistory& fix, int atom) {
    buffer_.resize(1 + 4 * static_cast<std::size_t>(fix.n_partner(atom)));
    fix.pack_exchange(atom, buffer_.data());
    count_ = static_cast<int>(Fix::ubuf(buffer_[0]).i);
  }
  std::int32_t partner(int k) const { return static_cast<std::int32_t>(Fix::ubuf(buffer_[1 + 4 * k]).i); }
  Vec3 displacement(int k) const { return vec3(&buffer_[2 + 4 * k]); }

 private:
  std::vector<double> buffer_;
  int count_ = 0;
};

/// What one rank says of a sphere of its own, and of a spring: of mesh `mesh`, or of a pair (-1).
struct SphereState {
  std::int64_t sphere;
  Vec3 position_m, velocity_m_s, angular_velocity_rad_s;
};
struct SpringState {
  std::int64_t mesh;
  Spring spring;
};

void sort(std::vector<Spring>& springs) {
  std::sort(springs.begin(), springs.end(), [](const Spring& a, const Spring& b) {
    return a.sphere != b.sphere ? a.sphere < b.sphere : a.partner < b.partner;
  });
}

}  // namespace

struct Session::Impl {
  void* handle = nullptr;
  LAMMPS_NS::LAMMPS* lmp = nullptr;
  FixContactHistory* pairs = nullptr;
  std::vector<std::string> mesh_names;
  std::vector<MeshFixes> meshes;
  bool abandoned = false;
  PackedSprings packed;
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
  FixContactHistory& history(Fix* fix, const char* name) const;
  void finish_set_up();
  int& lists_are_newer();
  bool owns(const Vec3& p) const;
  void create_atoms(const Spheres& spheres);
  void place(const Spheres& spheres);
  void give_pair_springs(const Spheres& spheres);
  void give_wall_springs(const std::vector<Spring>& springs, const MeshFixes& mesh);
  void read(Spheres& spheres);
};

Session::Session() : impl_(std::make_unique<Impl>()) {
  const Mpi& mpi = Mpi::started();
  const Quiet quiet;
  // It writes to its screen without asking whether it has one.
  std::string words[] = {"granrad", "-log", "none", "-screen", "/dev/null", "-echo", "none"};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  lammps_open(static_cast<int>(arguments.size()), arguments.data(), mpi.comm(), &impl_->handle);
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

FixContactHistory& Session::Impl::history(Fix* fix, const char* name) const {
  auto* found = dynamic_cast<FixContactHistory*>(fix);
  if (!found || found->get_dnum() != 3)
    throw InputError(
        advised(std::string("dem.engine = \"liggghts\" (no history of three values in ") + name + ")",
                "use libliggghts 3.8"));
  return *found;
}

void Session::add_mesh(const std::string& name, const WallMesh& mesh, std::int32_t type) {
  const StlFile file(mesh.triangles);
  std::string line = fmt::format("fix {} all mesh/surface file \"{}\" type {}", name, file.path(), type);
  if (const Vec3& v = mesh.velocity_m_s; v != Vec3{})
    line += fmt::format(" surface_vel {:.17g} {:.17g} {:.17g}", v.x, v.y, v.z);
  command(line);
  impl_->mesh_names.push_back(name);
}

/// The first run sets up meshes and makes the history fixes; spheres of all types must be there. Springs are
/// given after it.
void Session::Impl::finish_set_up() {
  set_up("run 0", [&] { command("run 0 post no"); });
  auto* modify = lmp->modify;
  pairs = &history(modify->find_fix_id("contacthistory"), "contacts");
  for (const auto& id : mesh_names) {
    auto* surface = dynamic_cast<FixMeshSurface*>(modify->find_fix_id(id.c_str()));
    auto* of_mesh = surface ? surface->contactHistory() : nullptr;
    auto* neighbours = modify->find_fix_id(("n_neighs_mesh_" + id).c_str());
    if (!neighbours)
      throw InputError(advised("dem.engine = \"liggghts\" (no neighbour count of mesh " + id + ")",
                               "use libliggghts 3.8"));
    meshes.push_back({&history(of_mesh, id.c_str()), neighbours});
  }
}

/// Whether neighbour lists hold newer springs than spheres do; LIGGGHTS takes them from there then.
int& Session::Impl::lists_are_newer() {
  int dimension = 0;
  auto* flag = static_cast<int*>(lmp->force->pair->extract("computeflag", dimension));
  if (!flag)
    throw InputError(advised("dem.engine = \"liggghts\" (no state of its lists)", "use libliggghts 3.8"));
  return *flag;
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
  if (Mpi::started().count() == 1) return;
  const auto part = [&] { return std::pair(vec3(lmp->domain->sublo), vec3(lmp->domain->subhi)); };
  const auto before = part();
  lmp->domain->reset_box();
  if (!Mpi::started().joined(std::vector<char>(before == part() ? 0 : 1)).empty()) create_atoms(spheres);
}

void Session::Impl::give_pair_springs(const Spheres& spheres) {
  std::vector<Spring> both = spheres.pair_springs;
  for (const auto& s : spheres.pair_springs) both.push_back({s.partner, s.sphere, -1.0 * s.displacement_m});
  sort(both);
  for (std::size_t k = 0; k < both.size();) {
    const auto sphere = both[k].sphere;
    packed.clear();
    for (; k < both.size() && both[k].sphere == sphere; ++k)
      packed.add(both[k].partner + 1, both[k].displacement_m);
    if (atom_of[sphere] >= 0) packed.unpack_into(*pairs, atom_of[sphere]);
  }
}

void Session::Impl::give_wall_springs(const std::vector<Spring>& springs, const MeshFixes& mesh) {
  for (int i = 0; i < lmp->atom->nlocal; ++i) mesh.neighbours->set_vector_atom_int(i, 0);
  for (std::size_t k = 0; k < springs.size();) {
    const auto sphere = springs[k].sphere;
    packed.clear();
    for (; k < springs.size() && springs[k].sphere == sphere; ++k)
      packed.add(springs[k].partner, springs[k].displacement_m);
    if (atom_of[sphere] < 0) continue;
    mesh.neighbours->set_vector_atom_int(atom_of[sphere], packed.count());
    packed.unpack_into(*mesh.history, atom_of[sphere]);
  }
}

void Session::Impl::read(Spheres& spheres) {
  auto& atom = *lmp->atom;
  lmp->modify->pre_exchange();  // history from the lists to the spheres
  std::vector<SphereState> states;
  std::vector<SpringState> springs;
  for (int i = 0; i < atom.nlocal; ++i) {
    const std::int32_t k = atom.tag[i] - 1;
    double unwrapped[3];
    lmp->domain->unmap(atom.x[i], atom.image[i], unwrapped);
    states.push_back({k, vec3(unwrapped), vec3(atom.v[i]), vec3(atom.omega[i])});
    packed.pack_from(*pairs, i);
    for (int p = 0; p < packed.count(); ++p)
      if (packed.partner(p) - 1 > k)
        springs.push_back({-1, {k, packed.partner(p) - 1, packed.displacement(p)}});
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      packed.pack_from(*meshes[m].history, i);
      for (int p = 0; p < packed.count(); ++p)
        springs.push_back({static_cast<std::int64_t>(m), {k, packed.partner(p), packed.displacement(p)}});
    }
  }
  states = Mpi::started().joined(states), springs = Mpi::started().joined(springs);
  if (states.size() != spheres.position_m.size())
    throw Refusal{std::to_string(spheres.position_m.size() - states.size()) + " particles left its domain"};
  for (const SphereState& s : states) {
    const auto k = static_cast<std::size_t>(s.sphere);
    spheres.position_m[k] = s.position_m;
    spheres.velocity_m_s[k] = s.velocity_m_s;
    spheres.angular_velocity_rad_s[k] = s.angular_velocity_rad_s;
  }
  spheres.pair_springs.clear();
  spheres.wall_springs.assign(meshes.size(), {});
  for (const SpringState& s : springs)
    (s.mesh < 0 ? spheres.pair_springs : spheres.wall_springs[static_cast<std::size_t>(s.mesh)])
        .push_back(s.spring);
  sort(spheres.pair_springs);
  for (auto& of_mesh : spheres.wall_springs) sort(of_mesh);
}

void Session::run(Spheres& spheres, std::int64_t steps) {
  try {
    impl_->guarded([&] {
      impl_->lmp->update->reset_timestep(LAMMPS_NS::bigint{0});  // schedules depend on the step
      impl_->place(spheres);
      if (!impl_->pairs) impl_->finish_set_up(), impl_->place(spheres);
      impl_->lists_are_newer() = 0;
      impl_->give_pair_springs(spheres);
      for (std::size_t m = 0; m < impl_->meshes.size(); ++m)
        impl_->give_wall_springs(spheres.wall_springs[m], impl_->meshes[m]);
      impl_->command("run " + std::to_string(steps) + " post no");
      impl_->read(spheres);
    });
  } catch (const Refusal& refusal) {
    throw NumericalError(
        advised("LIGGGHTS stopped: " + refusal.message, "try a smaller step or engine = \"native\""));
  }
}

}  // namespace granrad::liggghts
