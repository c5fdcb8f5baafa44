#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The calls of HDF5 that recordings need, without a type of HDF5. All throw SetupError saying what failed.
/// HDF5 need not be safe for threads: whoever calls them holds hdf5_mutex().
namespace flinch::internal {

std::mutex& hdf5_mutex();

/// An identifier of HDF5 that closes itself.
class Hdf5Object {
 public:
  using Id = std::int64_t;

  /// Throws SetupError where `id` is that of a failed call, saying what was being done.
  Hdf5Object(Id id, int (*close)(Id), const std::string& doing);
  Hdf5Object(Hdf5Object&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Object& operator=(Hdf5Object&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Object();
  /// Closes it now; returns whether that went well.
  bool close_now();
  operator Id() const { return id_; }  // NOLINT(google-explicit-constructor): it stands for the identifier

 private:
  Id id_;
  int (*close_)(Id);
};

/// Throws where a call of HDF5 that was `doing` something says that it failed.
void check(int status, const std::string& doing);
/// Throws saying of the data set `name` why it cannot be read.
[[noreturn]] void refuse(const std::string& name, const std::string& why);

/// HDF5 prints every failure of a thread unless that thread has told it not to; and at the end of the program
/// it would try again to write what could not be written, and crash.
void silence_hdf5();
/// Access properties of data sets whose chunks are written and read whole, one after the other: a cache of
/// chunks would only cost memory.
Hdf5Object without_chunk_cache();

/// Files and groups without time stamps, so that equal contents make equal files.
Hdf5Object create_hdf5_file(const std::filesystem::path& file);
Hdf5Object open_hdf5_file(const std::filesystem::path& file);
/// Bytes of the file that an object lies in.
std::size_t file_size(Hdf5Object::Id object);
/// Hands all that was written to the operating system. What was opened of the file must be closed before.
void close_hdf5_file(Hdf5Object file);
/// Lets a file that cannot be written be closed all the same: what HDF5 still keeps of it goes nowhere.
void abandon_hdf5_file(Hdf5Object::Id file) noexcept;
/// Writes a file of at most `most_bytes` of data beside its descriptions, as a ResultFile. `fill` closes what
/// it opens.
void write_hdf5_result(const std::filesystem::path& file, std::size_t most_bytes,
                       const std::function<void(Hdf5Object::Id file)>& fill);
/// Opens the group `path`; it and those around it are made where they are missing.
Hdf5Object make_group(Hdf5Object::Id file, const std::string& path);
/// Links are followed within the file only.
Hdf5Object open_group(Hdf5Object::Id file, const std::string& path);

void write_text(Hdf5Object::Id object, const std::string& name, const std::string& text);
void write_integer(Hdf5Object::Id object, const std::string& name, std::int64_t value);
/// Attributes of one value each, of the type that is read.
std::string read_text(Hdf5Object::Id object, const std::string& name);
std::int64_t read_integer(Hdf5Object::Id object, const std::string& name);
std::vector<std::string> attribute_names(Hdf5Object::Id object);

/// Makes a dataset of one column and `rows` rows: of texts of `text_width` bytes, without it of real numbers.
Hdf5Object make_column(Hdf5Object::Id parent, const std::string& name, std::size_t rows,
                       std::optional<std::size_t> text_width = std::nullopt);
/// Writes `rows` of its cells, which lie one behind the other, from row `first` on.
void write_cells(Hdf5Object::Id column, std::size_t first, std::size_t rows, const void* cells);

/// A data set of whatever type and size, for its attributes. Links are followed within the file only.
Hdf5Object open_data_set(Hdf5Object::Id parent, const std::string& name);
/// Where an object lies in its file: two names of one object have one address.
std::uint64_t address(Hdf5Object::Id object);
}  // namespace flinch::internal
