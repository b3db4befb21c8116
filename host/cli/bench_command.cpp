// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_command.h"

#include "host/cli/bench_build.h"
#include "host/cli/bench_gather.h"
#include "host/cli/bench_sort.h"
#include "host/cli/bench_trace.h"

namespace nearlight::core {

void add_bench_command(CommandLine& line) {
    CLI::App& group = line.add_command_group(
        "bench", "Benchmark one stage against Embree, TBB or the standard library, on the same work");
    add_bench_build(line, group);
    add_bench_gather(line, group);
    add_bench_sort(line, group);
    add_bench_trace(line, group);
}

}  // namespace nearlight::core
