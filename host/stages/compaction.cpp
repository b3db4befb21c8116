// SPDX-License-Identifier: Apache-2.0
#include "host/stages/compaction.h"

#include "host/stages/chunks.h"
#include "host/stages/joint_programs.h"

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
    const Chunks chunks = split_into_chunks(*device_, count);
    const std::size_t local_size = chunk_local_size(*device_);
    ensure_room(chunk_counts_, *device_, chunks.count);
    count_.launch(chunks.count, local_size, flags, chunk_counts_, n, chunks.size, chunks.count);
    scan_.exclusive(chunk_counts_, chunk_counts_, chunks.count);
    write_.launch(chunks.count, local_size, flags, chunk_counts_, indices, n, chunks.size, chunks.count);
    return scan_.total().download_one(0);
}

}  // namespace nearlight::core
