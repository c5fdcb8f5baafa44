#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

/// Files of MATLAB, level 5, by hand: the bytes that its "MAT-File Format" says.
namespace flinch::test {

inline std::string bytes_of_number(std::uint32_t number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// A tag, what it announces, and zeros up to a multiple of 8 bytes.
inline std::string mat_element(std::uint32_t type, std::string content) {
  const auto size = static_cast<std::uint32_t>(content.size());
  content.resize((content.size() + 7) / 8 * 8, '\0');
  return bytes_of_number(type) + bytes_of_number(size) + content;
}

/// How a type of C++ is called in a file: the class of an array of it, and the type of its numbers.
struct MatType {
  std::uint32_t array = 0;
  std::uint32_t numbers = 0;
};
inline constexpr MatType mat_double{6, 9}, mat_single{7, 7}, mat_int64{14, 12}, mat_uint8{9, 2};

inline std::string mat_head(std::uint32_t array, std::uint32_t down, std::uint32_t across,
                            const std::string& name) {
  return mat_element(6, bytes_of_number(array) + bytes_of_number(0)) +
         mat_element(5, bytes_of_number(down) + bytes_of_number(across)) + mat_element(1, name);
}

/// A matrix, whose numbers stand column by column.
template <class T>
std::string mat_matrix(MatType type, const std::string& name, std::uint32_t down, std::uint32_t across,
                       const std::vector<T>& numbers) {
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return mat_element(14, mat_head(type.array, down, across, name) + mat_element(type.numbers, bytes));
}

inline std::string mat_text(const std::string& name, const std::string& text) {
  return mat_element(14,
                     mat_head(4, 1, static_cast<std::uint32_t>(text.size()), name) + mat_element(16, text));
}

/// Structs side by side: names of the fields, and one matrix without a name for each field of each struct.
inline std::string mat_structs(const std::string& name, const std::vector<std::string>& fields,
                               const std::vector<std::string>& matrices) {
  constexpr std::size_t width = 32;
  std::string names;
  for (std::string field : fields) {
    field.resize(width, '\0');
    names += field;
  }
  std::string content = mat_head(2, 1, static_cast<std::uint32_t>(matrices.size() / fields.size()), name) +
                        bytes_of_number(4U << 16 | 5U) + bytes_of_number(width) + mat_element(1, names);
  for (const std::string& matrix : matrices) content += matrix;
  return mat_element(14, content);
}

/// The same variable deflated, as `save` does.
inline std::string mat_deflated(const std::string& variable) {
  uLongf size = compressBound(variable.size());
  std::string bytes(size, '\0');
  compress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(variable.data()),
           variable.size());
  bytes.resize(size);
  return bytes_of_number(15) + bytes_of_number(static_cast<std::uint32_t>(size)) + bytes;
}

inline std::string mat_file(const std::vector<std::string>& variables) {
  std::string bytes = "MATLAB 5.0 MAT-file";
  bytes.resize(124, ' ');
  bytes += std::string("\0\1IM", 4);
  for (const std::string& variable : variables) bytes += variable;
  return bytes;
}

}  // namespace flinch::test
