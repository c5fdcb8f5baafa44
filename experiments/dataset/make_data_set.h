#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "learning/data_set.h"

namespace flinch {

struct CampaignRun;
struct DataSpec;
struct ContactSamples;

/// Told now and then how many runs are done. Returns false to stop: what is done is kept.
using DataProgress = std::function<bool(std::size_t done)>;

/// Run `number` of the specification: which part it belongs to follows from the shares, what is drawn for it
/// from the seed and its number alone.
CampaignRun draw_contact(const DataSpec& spec, std::size_t number);

/// What the first contact of that run is learned from.
ContactSamples simulate_contact(const DataSpec& spec, std::size_t number);

/// Makes the data set on `threads` threads (0: one a processor) and writes it to `file`; the same bits for
/// any number of threads. Until it is whole, `file`.part keeps the runs that are done, from which the same
/// call goes on; before that one of them is made again, and must be the same. Throws SetupError where it is
/// not, for runs that cannot be made, for recordings that are no good or of another robot, and where it was
/// stopped.
DataSet make_data_set(const DataSpec& spec, const std::filesystem::path& file, std::size_t threads = 0,
                      const DataProgress& progress = {});

}  // namespace flinch
