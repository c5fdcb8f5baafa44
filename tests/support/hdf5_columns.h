#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "systems/framework/hdf5_object.h"

namespace flinch::test {

/// Write a dataset of one column each. For who fills a file with internal::write_hdf5_result().
inline void write_reals(internal::Hdf5Object::Id parent, const std::string& name,
                        const std::vector<double>& values) {
  internal::write_cells(internal::make_column(parent, name, values.size()), 0, values.size(), values.data());
}

inline void write_texts(internal::Hdf5Object::Id parent, const std::string& name,
                        const std::vector<std::string>& values) {
  std::size_t width = 1;
  for (const std::string& value : values) width = std::max(width, value.size());
  std::string cells;
  for (const std::string& value : values) cells += value + std::string(width - value.size(), '\0');
  internal::write_cells(internal::make_column(parent, name, values.size(), width), 0, values.size(),
                        cells.data());
}

}  // namespace flinch::test
