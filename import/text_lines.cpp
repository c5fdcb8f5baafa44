#include "import/text_lines.h"

#include <algorithm>
#include <cstring>

#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t piece = 1U << 18U;
constexpr std::string_view mark = "\xEF\xBB\xBF";

/// A letter as UTF-8.
void append(char32_t letter, std::string& text) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80U | ((letter >> shift) & 0x3FU)); };
  if (letter < 0x80) {
    text += static_cast<char>(letter);
  } else if (letter < 0x800) {
    text += static_cast<char>(0xC0U | (letter >> 6U));
    tail(0);
  } else if (letter < 0x10000) {
    text += static_cast<char>(0xE0U | (letter >> 12U));
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xF0U | (letter >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

/// By its mark, or by every second byte that is zero.
TextEncoding encoding_of(std::string_view head) {
  if (head.starts_with("\xFF\xFE")) return TextEncoding::utf16_little;
  if (head.starts_with("\xFE\xFF")) return TextEncoding::utf16_big;
  std::size_t even = 0, odd = 0;
  for (std::size_t i = 0; i < head.size(); ++i) (i % 2 == 0 ? even : odd) += head[i] == '\0' ? 1U : 0U;
  if (head.size() >= 8 && even == 0 && odd * 10 > head.size() * 4) return TextEncoding::utf16_little;
  if (head.size() >= 8 && odd == 0 && even * 10 > head.size() * 4) return TextEncoding::utf16_big;
  return TextEncoding::utf8;
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary) {
  const std::string problem = problem_with_reading(file);
  if (!problem.empty()) throw SetupError(file.string() + ": " + problem);
  std::string head(4096, '\0');
  stream_.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream_.gcount()));
  encoding_ = encoding_of(head);
  stream_.clear();
  stream_.seekg(encoding_ != TextEncoding::utf8 && (head[0] == '\xFF' || head[0] == '\xFE') ? 2
                : head.starts_with(mark)                                                    ? 3
                                                                                            : 0);
  while (buffer_.empty() && fill()) {
  }
  const std::string_view begin = std::string_view(buffer_).substr(0, 1U << 16U);
  const auto strange = std::count_if(begin.begin(), begin.end(), [](char letter) {
    return static_cast<unsigned char>(letter) < 0x20 && letter != '\n' && letter != '\r' && letter != '\t' &&
           letter != '\f' && letter != '\v';
  });
  // Zeros that a logger has filled its file with come in long runs.
  const bool has_lone_zeros = encoding_ == TextEncoding::utf8 && zeros_ < 16 * zero_runs_;
  if (strange * 50 > static_cast<std::ptrdiff_t>(begin.size()) || has_lone_zeros)
    throw SetupError(file.string() + ": is no text, and no format of logs that is known");
  if (begin.find('\n') == std::string_view::npos && begin.find('\r') != std::string_view::npos)
    line_end_ = '\r';
}

bool TextLines::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  std::string bytes(piece, '\0');
  stream_.read(bytes.data(), static_cast<std::streamsize>(piece));
  const auto count = static_cast<std::size_t>(stream_.gcount());
  if (encoding_ == TextEncoding::utf8) {
    append_utf8(bytes.data(), count);
  } else {
    append_utf16(bytes.data(), count);
  }
  return count > 0;
}

void TextLines::append_utf8(const char* bytes, std::size_t count) {
  if (std::memchr(bytes, '\0', count) == nullptr) {
    buffer_.append(bytes, count);
    return;
  }
  const std::size_t before = buffer_.size();
  std::remove_copy(bytes, bytes + count, std::back_inserter(buffer_), '\0');
  zeros_ += count - (buffer_.size() - before);
  for (std::size_t i = 0; i < count; ++i)
    zero_runs_ += bytes[i] == '\0' && (i == 0 || bytes[i - 1] != '\0') ? 1U : 0U;
}

void TextLines::append_utf16(const char* bytes, std::size_t count) {
  const std::string units = odd_byte_ + std::string(bytes, count);
  const std::size_t low = encoding_ == TextEncoding::utf16_little ? 0 : 1;
  for (std::size_t i = 0; i + 1 < units.size(); i += 2) {
    const char32_t unit = static_cast<unsigned char>(units[i + low]) +
                          (static_cast<char32_t>(static_cast<unsigned char>(units[i + 1 - low])) << 8U);
    if (unit >= 0xD800 && unit < 0xDC00) {
      surrogate_ = unit;
    } else if (unit >= 0xDC00 && unit < 0xE000 && surrogate_ != 0) {
      append(0x10000 + ((surrogate_ - 0xD800) << 10U) + (unit - 0xDC00), buffer_);
      surrogate_ = 0;
    } else if (unit == 0) {
      ++zeros_;
    } else if (unit != 0xFEFF) {
      append(unit, buffer_);
    }
  }
  odd_byte_ = units.size() % 2 == 1 ? units.substr(units.size() - 1) : "";
}

bool TextLines::next(std::string& line) {
  std::size_t searched = begin_;
  std::size_t end = buffer_.find(line_end_, searched);
  while (end == std::string::npos) {
    searched = buffer_.size() - begin_;
    if (!fill()) break;
    end = buffer_.find(line_end_, searched);
  }
  was_ended_ = end != std::string::npos;
  if (!was_ended_ && begin_ == buffer_.size()) return false;
  line.assign(buffer_, begin_, (was_ended_ ? end : buffer_.size()) - begin_);
  begin_ = was_ended_ ? end + 1 : buffer_.size();
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

}  // namespace flinch
