#include "export/csv_folder.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using internal::Number;

/// "station/joints" is no name of a file.
std::string file_name(std::string path) {
  std::replace(path.begin(), path.end(), '/', '.');
  return path + ".csv";
}

std::string header_of(const ExportedSignal& signal) {
  std::string line = "time_s";
  for (const ExportedField& field : signal.fields) {
    for (std::size_t i = 0; i < field.width(); ++i) {
      const std::string& unit = field.units[i];
      line += "," + field.column(i) + (unit.empty() || unit == "1" ? "" : " [" + unit + "]");
    }
  }
  return line + "\n";
}

template <class Value>
void append(Value value, std::string& text) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// Nanoseconds in seconds, with all digits that it has.
void append_seconds(std::int64_t time_ns, std::string& text) {
  constexpr std::int64_t second = 1'000'000'000;
  if (time_ns < 0) text += '-';
  const std::uint64_t size =
      time_ns < 0 ? 0 - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  append(size / second, text);
  std::uint64_t rest = size % second;
  if (rest == 0) return;
  char digits[9];
  for (int i = 8; i >= 0; --i, rest /= 10) digits[i] = static_cast<char>('0' + rest % 10);
  std::size_t length = 9;
  while (digits[length - 1] == '0') --length;
  text += '.';
  text.append(digits, length);
}

void append_row(const ExportedSignal& signal, const Number* row, std::string& text) {
  for (const ExportedField& field : signal.fields) {
    const std::size_t there = field.numbers_in(row);
    for (std::size_t i = 0; i < field.width(); ++i) {
      text += ',';
      if (i >= there) continue;
      const Number& number = row[field.first + i];
      if (field.kind == Field::Kind::real)
        append(number.real, text);
      else
        append(number.integer, text);
    }
  }
  text += '\n';
}

void write_table(const Recording& recording, const ExportedSignal& signal,
                 const std::filesystem::path& file) {
  ResultFile table(file);
  table.write(header_of(signal));
  for_each_block(recording, *signal.signal, [&](std::size_t first, std::size_t count, const Number* rows) {
    std::string text;
    for (std::size_t k = 0; k < count; ++k) {
      append_seconds(recording.time_ns[first + k], text);
      append_row(signal, rows + k * signal.signal->layout.numbers, text);
    }
    table.write(text);
  });
  table.finish();
}

}  // namespace

void write_csv_folder(const Recording& recording, const std::vector<ExportedSignal>& signals,
                      const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw SetupError(folder.string() + ": cannot be made: " + failed.message());
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr problem;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < signals.size(); i = next++)
        write_table(recording, signals[i], folder / file_name(signals[i].path));
    } catch (...) {
      next = signals.size();
      const std::lock_guard lock(mutex);
      if (!problem) problem = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      workers.emplace_back(work);
  }
  if (problem) std::rethrow_exception(problem);
  write_result(folder / "signals.json", description_json(recording, signals) + "\n");
}

}  // namespace flinch
