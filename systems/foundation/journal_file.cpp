#include "systems/foundation/journal_file.h"

#include <system_error>

#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void discard(const std::filesystem::path& file, std::ofstream& stream) {
  stream.close();
  remove_unfinished(file);
}

}  // namespace

void begin_journal(const std::filesystem::path& file, std::ofstream& stream,
                   const std::function<void()>& write) {
  const std::filesystem::path anew = file.string() + ".new";
  remove_link(anew);
  stream.open(anew, std::ios::binary | std::ios::trunc);
  try {
    write();
  } catch (...) {
    discard(anew, stream);
    throw;
  }
  std::error_code error;
  if (stream.flush()) std::filesystem::rename(anew, file, error);
  if (stream && !error) return;
  discard(anew, stream);
  throw SetupError(file.string() + ": the file cannot be written");
}

}  // namespace flinch
