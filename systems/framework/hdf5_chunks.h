#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "systems/framework/hdf5_object.h"
#include "systems/framework/stored_chunk.h"

/// Whether HDF5 can be handed a data set that anybody may have written. It believes what a file says of the
/// pieces in which its numbers are stored; here that is compared with what is there. All throw SetupError.
namespace flinch::internal {

/// Throws unless the table `name` lies in this file, in pieces of bounded size that only ordinary filters
/// have packed, in an order in which they can be checked.
void check_layout(Hdf5Object::Id table, const std::string& name);

/// Throws where a table claims to hold more than its bytes can be unpacked to.
void check_storage(Hdf5Object::Id table, const std::string& name, std::size_t rows, std::size_t columns);

/// The chunks in which some rows of a data set of two dimensions lie, where they hold numbers of exactly this
/// type, shuffled and deflated, as flinch writes them; none where they are stored otherwise. Throws where one
/// claims to be larger than the file.
std::vector<StoredChunk> taken_chunks(Hdf5Object::Id table, Hdf5Object::Id type, std::size_t first,
                                      std::size_t rows, std::size_t columns);

/// Which chunks of one data set, of one or two dimensions and a layout that was checked, can be unpacked to
/// their full size: HDF5 allocates what the file says that a chunk takes there, and copies a whole chunk from
/// what it was unpacked to.
class CheckedChunks {
 public:
  /// Unpacks each chunk that these rows lie in, once; throws where it has not its full size.
  void require(Hdf5Object::Id table, std::size_t first, std::size_t rows, std::size_t columns);

 private:
  std::vector<bool> good_;  ///< by the number of the chunk among those of its columns
};

}  // namespace flinch::internal
