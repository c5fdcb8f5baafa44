#include "import/matlab_log.h"

#include <matio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string_view>

#include "import/matlab_elements.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_columns = 1000;         // of a matrix, and structs of an array
constexpr int most_levels = 8;                     // of structs in structs
constexpr std::uint64_t most_deflated = 8 * 1032;  // bytes in memory for one byte of a deflated stream
constexpr double most_bytes = 4e9;                 // of a variable

using File = std::unique_ptr<mat_t, decltype(&Mat_Close)>;
using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

File open_file(const std::filesystem::path& file) {
  File opened(Mat_Open(file.c_str(), MAT_ACC_RDONLY), &Mat_Close);
  if (!opened) throw SetupError(file.string() + ": the file of MATLAB cannot be read; it is cut or broken");
  return opened;
}

/// What a matrix of one class looks like in memory.
struct NumberType {
  std::size_t bytes = 0;
  double (*number)(const void* data, std::size_t index) = nullptr;
  std::int64_t (*whole)(const void* data, std::size_t index) = nullptr;  ///< none: not of integers
};

template <class T>
double number_at(const void* data, std::size_t index) {
  return static_cast<double>(static_cast<const T*>(data)[index]);
}
template <class T>
std::int64_t whole_at(const void* data, std::size_t index) {
  return static_cast<std::int64_t>(static_cast<const T*>(data)[index]);
}

/// None: no numbers.
std::optional<NumberType> type_of(matio_classes type) {
  switch (type) {
    case MAT_C_DOUBLE:
      return NumberType{8, number_at<double>};
    case MAT_C_SINGLE:
      return NumberType{4, number_at<float>};
    case MAT_C_INT8:
      return NumberType{1, number_at<std::int8_t>, whole_at<std::int8_t>};
    case MAT_C_UINT8:
      return NumberType{1, number_at<std::uint8_t>, whole_at<std::uint8_t>};
    case MAT_C_INT16:
      return NumberType{2, number_at<std::int16_t>, whole_at<std::int16_t>};
    case MAT_C_UINT16:
      return NumberType{2, number_at<std::uint16_t>, whole_at<std::uint16_t>};
    case MAT_C_INT32:
      return NumberType{4, number_at<std::int32_t>, whole_at<std::int32_t>};
    case MAT_C_UINT32:
      return NumberType{4, number_at<std::uint32_t>, whole_at<std::uint32_t>};
    case MAT_C_INT64:
      return NumberType{8, number_at<std::int64_t>, whole_at<std::int64_t>};
    case MAT_C_UINT64:
      return NumberType{8, number_at<std::uint64_t>, whole_at<std::uint64_t>};
    default:
      return std::nullopt;
  }
}

/// Of a variable that holds no numbers, what it is.
std::string kind_of(const matvar_t& variable) {
  if (variable.isComplex != 0) return "complex numbers";
  switch (variable.class_type) {
    case MAT_C_CELL:
      return "a cell array";
    case MAT_C_SPARSE:
      return "a sparse matrix";
    case MAT_C_FUNCTION:
      return "a function";
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
      return "an object, such as a table or timeseries; save its arrays, 't = data.Time; x = data.Data;'";
    default:
      return "of a class that has no numbers";
  }
}

/// How the numbers of a matrix stand, column by column.
struct Shape {
  std::size_t rows = 0, columns = 0;  ///< the longer and the shorter dimension
  bool is_wide = false;               ///< rows are the second dimension

  std::size_t place(std::size_t row, std::size_t column) const {
    return is_wide ? row * columns + column : column * rows + row;
  }
};

/// None: it has other than 2 dimensions.
std::optional<Shape> shape_of(const matvar_t& variable) {
  if (variable.rank != 2 || variable.dims == nullptr) return std::nullopt;
  const std::size_t down = variable.dims[0], across = variable.dims[1];
  return Shape{std::max(down, across), std::min(down, across), across > down};
}

/// How many structs an array has; none: more than are looked at.
std::optional<std::size_t> structs_in(const matvar_t& variable) {
  std::size_t number = 1;
  for (int i = 0; i < variable.rank; ++i) {
    if (variable.dims[i] > most_columns) return std::nullopt;
    number *= variable.dims[i];
    if (number > most_columns) return std::nullopt;
  }
  return number;
}

/// None: the file is damaged there.
matvar_t* field_of(matvar_t& structs, std::size_t field, std::size_t index) {
  return structs.data == nullptr ? nullptr : Mat_VarGetStructFieldByIndex(&structs, field, index);
}

/// Bytes that a variable takes in memory, as its file says.
double bytes_of(matvar_t* variable) {
  if (variable == nullptr) return 0.0;
  double numbers = 1.0;
  for (int i = 0; i < variable->rank; ++i) numbers *= static_cast<double>(variable->dims[i]);
  if (variable->class_type != MAT_C_STRUCT) return 8.0 * numbers;
  const std::optional<std::size_t> structs = structs_in(*variable);
  double bytes = 0.0;
  for (std::size_t i = 0; structs && i < *structs; ++i) {
    for (unsigned field = 0; field < Mat_VarGetNumberOfFields(variable); ++field)
      bytes += bytes_of(field_of(*variable, field, i));
  }
  return bytes;
}

/// A variable with its numbers. Throws SetupError for one that the file cannot hold.
Variable read_variable(const std::filesystem::path& file, const std::string& name) {
  const File opened = open_file(file);
  const Variable told(Mat_VarReadInfo(opened.get(), name.c_str()), &Mat_VarFree);
  const auto held = static_cast<double>(most_deflated * std::filesystem::file_size(file));
  if (!told || bytes_of(told.get()) > std::min(held, most_bytes))
    throw SetupError(file.string() + ": '" + name + "' says that it has more numbers than the file holds");
  Variable variable(Mat_VarRead(opened.get(), name.c_str()), &Mat_VarFree);
  if (!variable)
    throw SetupError(file.string() + ": '" + name + "' cannot be read; the file is cut or broken");
  return variable;
}

/// The matrix at the end of a path of elements and fields.
const matvar_t* inside(matvar_t* variable, const std::vector<std::size_t>& path) {
  for (std::size_t i = 0; variable != nullptr && i + 1 < path.size(); i += 2) {
    if (variable->class_type != MAT_C_STRUCT) return nullptr;
    variable = field_of(*variable, path[i + 1], path[i]);
  }
  return variable;
}

}  // namespace

/// Goes through a variable and what is in it, and notes the columns.
class MatlabLog::Visitor {
 public:
  Visitor(MatlabLog& log, const char* variable) : log_(log), variable_(variable) {}

  /// `name`: of `variable`, from the one of the file on; `group`: of the struct that it is a field of.
  void visit(matvar_t* variable, const std::string& name, const std::string& group) {
    if (variable == nullptr || variable->class_type == MAT_C_EMPTY) return;
    if (variable->class_type == MAT_C_STRUCT)
      visit_structs(*variable, name);
    else if (type_of(variable->class_type) && variable->isComplex == 0)
      add_matrix(*variable, name, group);
    else if (variable->class_type == MAT_C_CHAR)
      texts_.push_back(name);
    else
      leave_out(name, "is " + kind_of(*variable));
  }

  /// Those that were seen.
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  void visit_structs(matvar_t& array, const std::string& name) {
    const std::optional<std::size_t> structs = structs_in(array);
    if (!structs) return leave_out(name, "has more than " + std::to_string(most_columns) + " structs");
    if (path_.size() / 2 >= most_levels) return leave_out(name, "lies too deep");
    const unsigned fields = Mat_VarGetNumberOfFields(&array);
    char* const* const names = Mat_VarGetStructFieldnames(&array);
    for (std::size_t i = 0; i < *structs; ++i) {
      const std::string one = *structs == 1 ? name : name + "[" + std::to_string(i) + "]";
      for (unsigned field = 0; names != nullptr && field < fields; ++field) {
        path_.insert(path_.end(), {i, field});
        visit(field_of(array, field, i), one + "." + names[field], one);
        path_.resize(path_.size() - 2);
      }
    }
  }

  void add_matrix(const matvar_t& matrix, const std::string& name, const std::string& group) {
    const std::optional<Shape> shape = shape_of(matrix);
    if (!shape) return leave_out(name, "has " + std::to_string(matrix.rank) + " dimensions; a table has 2");
    if (shape->columns > most_columns)
      return leave_out(name, "has " + std::to_string(shape->columns) + " columns");
    for (std::size_t i = 0; shape->rows > 0 && i < shape->columns; ++i) {
      log_.columns_.push_back({.name = shape->columns == 1 ? name : name + "[" + std::to_string(i) + "]",
                               .table = group + ":" + std::to_string(shape->rows),
                               .rows = shape->rows});
      log_.places_.push_back({variable_, path_, i});
    }
  }

  void leave_out(const std::string& name, const std::string& reason) {
    log_.remarks_.push_back("'" + name + "' " + reason + "; left out");
  }

  MatlabLog& log_;
  std::string variable_;
  std::vector<std::size_t> path_;
  std::vector<std::string> texts_;
};

bool is_matlab(const std::filesystem::path& file) {
  std::array<char, 128> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  const std::string_view order(head.data() + 126, 2);
  return stream && (order == "IM" || order == "MI");
}

MatlabLog::MatlabLog(const std::filesystem::path& file) {
  file_ = file;
  out_of(file.string(), [&] { check_matlab_elements(file); });
  const File opened = open_file(file);
  for (;;) {
    const Variable variable(Mat_VarReadNextInfo(opened.get()), &Mat_VarFree);
    if (!variable) break;
    if (variable->name == nullptr || std::string_view(variable->name).empty()) continue;
    Visitor visitor(*this, variable->name);
    visitor.visit(variable.get(), variable->name, "");
    const std::size_t texts = visitor.texts().size();
    if (texts == 1) remarks_.push_back("'" + visitor.texts().front() + "' is a text; left out");
    if (texts > 1)
      remarks_.push_back("'" + visitor.texts().front() + "' and " + std::to_string(texts - 1) +
                         " others in '" + variable->name + "' are texts; left out");
  }
  throw_if_empty("matrix of numbers that can be read");
}

/// Calls `take` for each wanted column, in groups of one variable, which are in memory one after the other:
/// with its index among the wanted, its numbers and where they stand.
template <class Take>
void MatlabLog::visit_columns(std::span<const std::size_t> wanted, const Take& take) const {
  std::map<std::string, std::vector<std::size_t>> of_variable;
  for (std::size_t i = 0; i < wanted.size(); ++i) of_variable[places_[wanted[i]].variable].push_back(i);
  for (const auto& [name, columns] : of_variable) {
    const Variable variable = read_variable(file_, name);
    for (const std::size_t i : columns) {
      const matvar_t* const matrix = inside(variable.get(), places_[wanted[i]].path);
      const std::optional<NumberType> type = matrix ? type_of(matrix->class_type) : std::nullopt;
      const std::optional<Shape> shape = matrix ? shape_of(*matrix) : std::nullopt;
      const bool fits = type && shape && matrix->data != nullptr && matrix->isComplex == 0 &&
                        matrix->nbytes >= shape->rows * shape->columns * type->bytes;
      if (!fits || shape->rows != columns_[wanted[i]].rows)
        throw SetupError(file_.string() + ": '" + columns_[wanted[i]].name +
                         "' cannot be read; the file is cut or broken");
      take(i, *matrix, *type, *shape);
    }
  }
}

std::vector<std::vector<double>> MatlabLog::read(std::span<const std::size_t> wanted, std::size_t most_rows) {
  std::vector<std::vector<double>> numbers(wanted.size());
  visit_columns(
      wanted, [&](std::size_t i, const matvar_t& matrix, const NumberType& type, const Shape& shape) {
        numbers[i].resize(std::min(shape.rows, most_rows));
        for (std::size_t row = 0; row < numbers[i].size(); ++row) {
          const double value = type.number(matrix.data, shape.place(row, places_[wanted[i]].column));
          numbers[i][row] = std::isfinite(value) ? value : std::nan("");
        }
      });
  return numbers;
}

std::vector<std::int64_t> MatlabLog::read_instants(std::size_t column, ClockUnit unit,
                                                   std::size_t most_rows) {
  std::vector<std::int64_t> instants;
  visit_columns(std::array{column}, [&](std::size_t, const matvar_t& matrix, const NumberType& type,
                                        const Shape& shape) {
    instants.resize(std::min(shape.rows, most_rows));
    for (std::size_t row = 0; row < instants.size(); ++row) {
      const std::size_t place = shape.place(row, places_[column].column);
      instants[row] = type.whole && unit == ClockUnit::ns ? type.whole(matrix.data, place)
                                                          : instant_of(type.number(matrix.data, place), unit);
    }
  });
  return instants;
}

}  // namespace flinch
