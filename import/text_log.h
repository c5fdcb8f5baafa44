#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "import/log_file.h"
#include "import/text_layout.h"

namespace flinch {

/// A table in a text: any separator, decimal comma or point, comments, lines above it, several rows of names
/// and units or none, quotes as RFC 4180 has them. Only the columns that are read stay in memory, 8 bytes a
/// number.
class TextLog final : public LogFile {
 public:
  /// Throws SetupError naming the file, and the line where there is one, of what is no table.
  explicit TextLog(const std::filesystem::path& file);

  std::vector<std::vector<double>> read(std::span<const std::size_t> wanted, std::size_t most_rows) override;
  std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) override;

  const TextLayout& layout() const { return layout_; }

 private:
  using Take = std::function<void(std::size_t wanted, std::string_view cell, std::size_t line)>;
  /// Hands on the cells of wanted columns, row by row, "" of those that are missing; `next_row` before each.
  void visit(std::span<const std::size_t> wanted, std::size_t most_rows,
             const std::function<void()>& next_row, const Take& take);
  std::size_t expected_rows(std::size_t most_rows, std::size_t columns) const;

  TextLayout layout_;
  bool told_rows_ = false;  ///< the remarks on rows, which every reading meets
};

}  // namespace flinch
