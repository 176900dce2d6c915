#include "dem/liggghts/refusal.h"

#define OMPI_SKIP_MPICXX
#include <liggghts/error.h>
#include <liggghts/fix.h>

// LIGGGHTS calls its error functions through the dynamic linker, which takes these before its own.
namespace LAMMPS_NS {

using granrad::liggghts::Refusal;

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
