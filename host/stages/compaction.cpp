// SPDX-License-Identifier: Apache-2.0
#include "host/stages/compaction.h"

#include "host/stages/joint_programs.h"
#include "host/stages/runs.h"

namespace nearlight::core {

Compaction::Compaction(Device& device)
    : device_(&device),
      program_(device, "compaction.cl", kVplsProgram),
      count_(program_, "compaction_count"),
      write_(program_, "compaction_write"),
      gather_(program_, "compaction_gather"),
      scan_(device) {}

std::size_t Compaction::list_set(const Buffer<uint>& flags, std::size_t count, Buffer<uint>& indices) {
    if (count == 0) {
        return 0;
    }
    const uint n = to_kernel_count(count, "flags");
    const Runs runs = split_into_runs(*device_, count);
    const std::size_t local_size = run_local_size(*device_);
    ensure_room(run_counts_, *device_, runs.count);
    count_.launch(runs.count, local_size, flags, run_counts_, n, runs.size, runs.count);
    scan_.exclusive(run_counts_, run_counts_, runs.count);
    write_.launch(runs.count, local_size, flags, run_counts_, indices, n, runs.size, runs.count);
    return scan_.total().download_one(0);
}

}  // namespace nearlight::core
