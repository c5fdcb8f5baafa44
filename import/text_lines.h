#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace flinch {

/// How the letters of a text are written.
enum class TextEncoding : std::uint8_t { utf8, utf16_little, utf16_big };

/// The lines of a text file, one after the other, as UTF-8 without a mark of the byte order. Lines end in LF,
/// CR LF or CR. Bytes of zero, with which loggers fill files beforehand, are left out.
class TextLines {
 public:
  /// Throws SetupError naming the file where it cannot be read or is no text.
  explicit TextLines(const std::filesystem::path& file);

  /// Whether there was another line, which is then in `line`.
  bool next(std::string& line);

  TextEncoding encoding() const { return encoding_; }
  /// Whether the line read last had an end: the last one of a file need not.
  bool was_ended() const { return was_ended_; }
  /// Bytes of zero so far.
  std::size_t zeros() const { return zeros_; }

 private:
  bool fill();
  void append_utf8(const char* bytes, std::size_t count);
  void append_utf16(const char* bytes, std::size_t count);

  std::filesystem::path file_;
  std::ifstream stream_;
  TextEncoding encoding_ = TextEncoding::utf8;
  std::string buffer_;  ///< what was read and is in no line yet
  std::size_t begin_ = 0;
  char line_end_ = '\n';
  char32_t surrogate_ = 0;  ///< the first half of a letter
  std::string odd_byte_;    ///< the first of a unit of two
  bool was_ended_ = true;
  std::size_t zeros_ = 0;
  std::size_t zero_runs_ = 0;
};

}  // namespace flinch
