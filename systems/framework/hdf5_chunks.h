#pragma once

#include <cstddef>
#include <string>

#include "systems/framework/hdf5_object.h"

/// Whether HDF5 can be handed a data set that anybody may have written. It believes what a file says of the
/// pieces in which its numbers are stored; here that is compared with what is there. All throw SetupError.
namespace flinch::internal {

/// Throws unless the table `name` lies in this file, in pieces of bounded size that only ordinary filters
/// have packed, in an order in which they can be checked.
void check_layout(Hdf5Object::Id table, const std::string& name);

/// Throws where a table claims to hold more than its bytes can be unpacked to.
void check_storage(Hdf5Object::Id table, const std::string& name, std::size_t rows, std::size_t columns);

/// Throws unless each chunk that these rows lie in can be unpacked to its full size: HDF5 allocates what the
/// file says that a chunk takes there, and copies a whole chunk from what it was unpacked to. Of tables with
/// one or two dimensions whose layout was checked.
void check_chunks(Hdf5Object::Id table, std::size_t first, std::size_t rows, std::size_t columns);

}  // namespace flinch::internal
