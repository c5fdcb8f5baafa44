#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/log_file.h"
#include "import/zip_archive.h"

namespace flinch {

/// What the head of an array of NumPy says of it.
struct NumpyShape {
  char kind = 'f';          ///< f real, i integer, u without sign, b truth, M instant
  std::size_t width = 8;    ///< of a number [bytes]
  bool is_big = false;      ///< the highest byte first
  bool is_fortran = false;  ///< the first index runs fastest
  std::size_t rows = 0;     ///< the longer dimension
  std::size_t columns = 1;  ///< the other
  bool is_wide = false;     ///< rows are the second dimension
  std::string unit;         ///< of instants, "ns"
  std::size_t head = 0;     ///< bytes before the numbers
};

/// The head of an array; throws SetupError for one that is no table of numbers, with what it is.
NumpyShape numpy_shape(const std::string& bytes);

/// Arrays of NumPy, one in a file .npy or several in an archive .npz: "q", or of several columns "q[0]" and
/// on. Of two dimensions the longer one are the rows. Arrays with as many rows are one table.
class NumpyLog final : public LogFile {
 public:
  /// Throws SetupError naming the file and what is missing or broken.
  explicit NumpyLog(const std::filesystem::path& file);

  std::vector<std::vector<double>> read(std::span<const std::size_t> wanted, std::size_t most_rows) override;
  std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) override;

 private:
  /// Where a column lies.
  struct Place {
    std::size_t array = 0;
    std::size_t column = 0;
  };
  struct Array {
    std::string name;
    std::optional<ZipEntry> entry;  ///< none: the file is the array
    NumpyShape shape;
  };

  std::string bytes_of(const Array& array, std::uint64_t most) const;
  /// All bytes; what is wrong with them is told with the name of the file.
  std::string whole(const Array& array) const;
  void add(Array array);

  std::vector<Array> arrays_;
  std::vector<Place> places_;
};

bool is_numpy(const std::filesystem::path& file);

}  // namespace flinch
