// SPDX-License-Identifier: Apache-2.0
#include "host/bench/sort_bench.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>

#include "host/base/fork_join.h"
#include "host/base/random.h"
#include "host/bench/statistics.h"
#include "host/stages/morton_sort.h"
#include "host/stages/prefix_scan.h"

namespace nearlight::core {
namespace {

// Bytes that the sort moves for each pair: each of the four passes reads the key, then reads and writes key
// and value.
constexpr double kSortBytes = 4.0 * 5.0 * sizeof(uint);
// Bytes that the prefix sum moves for each number, which is read to be reduced, then read and written to be
// summed.
constexpr double kScanBytes = 3.0 * sizeof(uint);

struct SortContestant {
    std::string name;
    double bytes;
    std::function<void()> lay_out;
    std::function<void()> run;
    std::function<bool()> is_right;
};

/// The data and the right answers.
struct SortWork {
    explicit SortWork(std::size_t count) : keys(count), values(count), pairs(count) {
        Pcg32 random(1);
        for (std::size_t i = 0; i < count; ++i) {
            keys[i] = random.next();
            values[i] = static_cast<uint>(i);
            pairs[i] = std::uint64_t{keys[i]} << 32u | i;
        }
        sorted = pairs;
        std::sort(sorted.begin(), sorted.end());
        sums.resize(count);
        std::exclusive_scan(keys.begin(), keys.end(), sums.begin(), 0u);
    }
    std::vector<uint> keys, values, sums;
    std::vector<std::uint64_t> pairs, sorted;
};

SortContestant device_sort(Device& device, const SortWork& work) {
    struct State {
        State(Device& on, std::size_t count) : sort(on), keys(on, count), values(on, count) {}
        MortonSort sort;
        Buffer<uint> keys, values;
    };
    const auto state = std::make_shared<State>(device, work.keys.size());
    return {"nearlight sort", kSortBytes,
            [state, &work] {
                state->keys.upload(work.keys);
                state->values.upload(work.values);
            },
            [state, &device] {
                state->sort.sort(state->keys, state->values, state->keys.count());
                device.finish();
            },
            [state, &work] {
                const std::vector<uint> values = state->values.download();
                return std::equal(
                    values.begin(), values.end(), work.sorted.begin(), work.sorted.end(),
                    [](uint value, std::uint64_t pair) { return value == static_cast<uint>(pair); });
            }};
}

template <typename Sort>
SortContestant host_sort(const std::string& name, const SortWork& work, Sort sort) {
    const auto pairs = std::make_shared<std::vector<std::uint64_t>>();
    return {name, 0.0, [pairs, &work] { *pairs = work.pairs; }, [pairs, sort] { sort(*pairs); },
            [pairs, &work] { return *pairs == work.sorted; }};
}

SortContestant device_scan(Device& device, const SortWork& work) {
    struct State {
        State(Device& on, std::span<const uint> numbers)
            : scan(on), input(on, numbers), output(on, numbers.size()) {}
        PrefixScan<uint> scan;
        Buffer<uint> input, output;
    };
    const auto state = std::make_shared<State>(device, work.keys);
    return {"nearlight scan", kScanBytes, [] {},
            [state, &device] {
                state->scan.exclusive(state->input, state->output, state->input.count());
                device.finish();
            },
            [state, &work] { return state->output.download() == work.sums; }};
}

SortContestant host_scan(const SortWork& work) {
    const auto sums = std::make_shared<std::vector<uint>>(work.keys.size());
    return {"std::exclusive_scan", 2.0 * sizeof(uint), [] {},
            [sums, &work] { std::exclusive_scan(work.keys.begin(), work.keys.end(), sums->begin(), 0u); },
            [sums, &work] { return *sums == work.sums; }};
}

/// The speed of memory: all cores copy.
SortContestant copy(const SortWork& work) {
    const auto to = std::make_shared<std::vector<std::uint64_t>>(work.pairs.size());
    return {"copy of the pairs", 2.0 * sizeof(std::uint64_t), [] {},
            [to, &work] {
                const auto copy_part = [&](const auto& range) {
                    std::memcpy(to->data() + range.begin(), work.pairs.data() + range.begin(),
                                range.size() * sizeof(std::uint64_t));
                };
                ForkJoin fork;
                tbb::parallel_for(tbb::blocked_range<std::size_t>(0, to->size(), 1u << 16u),
                                  fork.task(copy_part));
            },
            [to, &work] { return *to == work.pairs; }};
}

}  // namespace

SortBenchResult bench_sort(Device& device, const SortBenchConfig& config) {
    const SortWork work(config.count);
    const std::vector<SortContestant> contestants{
        device_sort(device, work),
        host_sort("std::sort", work, [](auto& pairs) { std::sort(pairs.begin(), pairs.end()); }),
        host_sort("tbb::parallel_sort", work,
                  [](auto& pairs) { tbb::parallel_sort(pairs.begin(), pairs.end()); }),
        device_scan(device, work),
        host_scan(work),
        copy(work)};
    std::vector<std::vector<Seconds>> runs(contestants.size());
    SortBenchResult result{.device = device.name(), .count = config.count, .figures = {}, .ratios = {}};
    for (const SortContestant& contestant : contestants) {
        contestant.lay_out();
        contestant.run();  // warms up
        result.figures.push_back({contestant.name,
                                  {},
                                  contestant.bytes * static_cast<double>(config.count),
                                  contestant.is_right()});
    }
    for (int repeat = 0; repeat < config.repeats; ++repeat) {
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            contestants[i].lay_out();
            const TwoClocks clocks(TwoClocks::Of::process);
            contestants[i].run();
            runs[i].push_back(clocks.seconds());
        }
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
        result.figures[i].median = medians(runs[i]);
    }
    const auto add_ratio = [&](const std::string& name, std::size_t theirs, std::size_t ours, double factor) {
        const double processor = factor * ratio(runs[theirs], runs[ours], &Seconds::processor).median;
        result.ratios.push_back({name, factor * ratio(runs[theirs], runs[ours], &Seconds::wall).median,
                                 device.is_cpu() ? processor : 0.0});
    };
    enum { kSort, kStdSort, kParallelSort, kScan, kStdScan, kCopy };
    add_ratio("sort ÷ std::sort", kStdSort, kSort, 1.0);
    add_ratio("sort ÷ tbb::parallel_sort", kParallelSort, kSort, 1.0);
    add_ratio("sort ÷ memory bandwidth", kCopy, kSort, kSortBytes / contestants[kCopy].bytes);
    add_ratio("scan ÷ std::exclusive_scan", kStdScan, kScan, 1.0);
    add_ratio("scan ÷ memory bandwidth", kCopy, kScan, kScanBytes / contestants[kCopy].bytes);
    return result;
}

}  // namespace nearlight::core
