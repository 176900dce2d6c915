#pragma once
#include <map>
#include <string>

namespace granrad {

/// What a document that is no file answers to its readers, so that they show which keys they know.
struct Exploration {
  enum Depth {
    bare,    ///< no table is there
    tables,  ///< every table is there, one of every list; no key is
    keys,    ///< every key that may be asked for is there as well
  };
  Depth depth = bare;
  std::map<std::string, std::string>
      picks;  ///< answers to choices and booleans, by "table.name"; else the default
};

}  // namespace granrad
