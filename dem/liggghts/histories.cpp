#include "dem/liggghts/histories.h"

#define OMPI_SKIP_MPICXX
#include <liggghts/atom.h>
#include <liggghts/fix.h>
#include <liggghts/fix_contact_history.h>
#include <liggghts/fix_contact_history_mesh.h>
#include <liggghts/fix_mesh_surface.h>
#include <liggghts/force.h>
#include <liggghts/lammps.h>
#include <liggghts/modify.h>
#include <liggghts/pair.h>

#include <algorithm>

#include "dem/base/error.h"

namespace granrad::liggghts {

namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::FixContactHistory;
using LAMMPS_NS::FixMeshSurface;

InputError unexpected(const std::string& what) {
  return InputError(advised("dem.engine = \"liggghts\" (" + what + ")", "use libliggghts 3.8"));
}

FixContactHistory& history(Fix* fix, const std::string& name) {
  auto* found = dynamic_cast<FixContactHistory*>(fix);
  if (!found || found->get_dnum() != 3) throw unexpected("no history of three values in " + name);
  return *found;
}

}  // namespace

Histories::Histories(LAMMPS_NS::LAMMPS& lmp, const std::vector<std::string>& mesh_names)
    : lmp_(lmp), pairs_(&history(lmp.modify->find_fix_id("contacthistory"), "contacts")) {
  for (const auto& id : mesh_names) {
    auto* surface = dynamic_cast<FixMeshSurface*>(lmp.modify->find_fix_id(id.c_str()));
    auto* neighbours = lmp.modify->find_fix_id(("n_neighs_mesh_" + id).c_str());
    if (!neighbours) throw unexpected("no neighbour count of mesh " + id);
    meshes_.push_back({&history(surface ? surface->contactHistory() : nullptr, id), neighbours});
  }
}

/// Whether neighbour lists hold newer springs than atoms do; LIGGGHTS takes them from there then.
int& Histories::lists_are_newer() {
  int dimension = 0;
  auto* flag = static_cast<int*>(lmp_.force->pair->extract("computeflag", dimension));
  if (!flag) throw unexpected("no state of its lists");
  return *flag;
}

void Histories::give_atom(int atom, const Given* begin, const Given* end) {
  const auto of_fix = [&](std::int32_t mesh, FixContactHistory& fix) {
    buffer_.assign(1, 0.0);
    int count = 0;
    for (const Given* g = begin; g != end; ++g) {
      if (g->mesh != mesh) continue;
      buffer_.push_back(Fix::ubuf(g->partner).d);
      for (int a = 0; a < 3; ++a) buffer_.push_back(g->displacement_m[a]);
      ++count;
    }
    if (count == 0) return;
    if (mesh != Spring::pair)
      meshes_[static_cast<std::size_t>(mesh)].neighbours->set_vector_atom_int(atom, count);
    buffer_[0] = Fix::ubuf(count).d;
    fix.unpack_exchange(atom, buffer_.data());
  };
  for (std::size_t m = 0; m < meshes_.size(); ++m) of_fix(static_cast<std::int32_t>(m), *meshes_[m].history);
  of_fix(Spring::pair, *pairs_);
}

/// Sorted by atom by counting: springs come by sphere, so that each atom gets its partners in ascending order.
void Histories::give(const std::vector<Spring>& springs, const std::vector<std::int32_t>& atom_of) {
  lists_are_newer() = 0;
  const auto atoms = static_cast<std::size_t>(lmp_.atom->nlocal);
  for (const OfMesh& mesh : meshes_)
    for (int i = 0; i < lmp_.atom->nlocal; ++i) mesh.neighbours->set_vector_atom_int(i, 0);
  const auto visit = [&](auto&& take) {
    for (const Spring& s : springs) {
      const bool pair = s.mesh == Spring::pair;
      const std::int32_t first = atom_of[static_cast<std::size_t>(s.sphere)];
      if (first >= 0)
        take(static_cast<std::size_t>(first),
             Given{s.mesh, pair ? s.partner + 1 : s.partner, s.displacement_m});
      const std::int32_t second = pair ? atom_of[static_cast<std::size_t>(s.partner)] : -1;
      if (second >= 0)
        take(static_cast<std::size_t>(second), Given{s.mesh, s.sphere + 1, -1.0 * s.displacement_m});
    }
  };
  std::vector<std::size_t> next(atoms + 1, 0);
  visit([&](std::size_t atom, const Given&) { ++next[atom + 1]; });
  for (std::size_t i = 0; i < atoms; ++i) next[i + 1] += next[i];
  std::vector<Given> given(next[atoms]);
  visit([&](std::size_t atom, const Given& g) { given[next[atom]++] = g; });
  for (std::size_t i = 0; i < atoms; ++i) {  // next[i] is now where atom i ends
    const std::size_t begin = i == 0 ? 0 : next[i - 1];
    if (begin != next[i]) give_atom(static_cast<int>(i), &given[begin], &given[begin] + (next[i] - begin));
  }
}

void Histories::collect() {
  lmp_.modify->pre_exchange();
}

/// The springs of an atom in one history, into buffer_; how many.
int Histories::pack(FixContactHistory& fix, int atom) {
  buffer_.resize(1 + 4 * static_cast<std::size_t>(fix.n_partner(atom)));
  fix.pack_exchange(atom, buffer_.data());
  return static_cast<int>(Fix::ubuf(buffer_[0]).i);
}

void Histories::append(int atom, std::int32_t sphere, std::vector<Spring>& out) {
  const auto of_fix = [&](std::int32_t mesh, FixContactHistory& fix) {
    const std::size_t begin = out.size();
    const int count = pack(fix, atom);
    for (int k = 0; k < count; ++k) {
      const double* packed = &buffer_[1 + 4 * static_cast<std::size_t>(k)];
      const auto told = static_cast<std::int32_t>(Fix::ubuf(packed[0]).i);
      const std::int32_t partner = mesh == Spring::pair ? told - 1 : told;
      if (mesh == Spring::pair && partner < sphere) continue;
      out.push_back({sphere, mesh, partner, {packed[1], packed[2], packed[3]}});
    }
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(),
              [](const Spring& a, const Spring& b) { return a.partner < b.partner; });
  };
  for (std::size_t m = 0; m < meshes_.size(); ++m) of_fix(static_cast<std::int32_t>(m), *meshes_[m].history);
  of_fix(Spring::pair, *pairs_);
}

}  // namespace granrad::liggghts
