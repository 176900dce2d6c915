#pragma once
#include "dem/native/hertz_mindlin.h"

namespace granrad::native {

/// The law of all contacts.
using ContactLaw = HertzMindlin;

using LawCoefficients = ContactLaw::Values<double>;

}  // namespace granrad::native
