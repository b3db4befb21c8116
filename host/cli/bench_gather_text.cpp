// SPDX-License-Identifier: Apache-2.0
#include "host/cli/bench_gather_text.h"

#include "host/cli/log.h"

namespace nearlight::core {
namespace {

constexpr std::uint64_t kMaxLines = 10;  // disagreements per tracer

std::string line_of(const Disagreement& item) {
    const std::string says =
        item.is_culling ? (item.tracer_says ? "traces" : "culls") : (item.tracer_says ? "hits" : "passes");
    return fmt::format(
        "  {} {} packet {} lane {} VPL {}: ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}), {} "
        "{:.3g}{}{}\n",
        item.tracer, says, item.packet, item.lane, item.vpl, item.from.x, item.from.y, item.from.z, item.to.x,
        item.to.y, item.to.z, item.is_culling ? "cosine" : "nearest edge at", item.distance,
        item.is_at_margin ? ", meets a triangle at its end" : "", item.excused ? "" : ", TOO FAR");
}

std::string head(const std::string& name, BvhQuality bvh, const GatherBenchResult& result) {
    return fmt::format("{}: {} triangles in a {} tree, device {}\n", name, result.triangles, to_string(bvh),
                       result.device) +
           fmt::format("{:.2f} M pairs, {:.2f} M after culling, {:.2f} M rays traced\n",
                       millions(result.pairs), millions(result.after_culling),
                       millions(result.tracers[result.ours].rays));
}

std::string table(const GatherBenchResult& result) {
    std::string text =
        fmt::format("{:>10} {:>10} {:>11} {:>8}\n", "Mrays/s", "Mpairs/s", "processor s", "differ");
    for (const TracerFigures& tracer : result.tracers) {
        text += fmt::format("{:>10.2f} {:>10.2f} {:>11.3f} {:>8}  {}\n",
                            millions(tracer.rays) / tracer.median.wall,
                            millions(result.pairs) / tracer.median.wall, tracer.median.processor,
                            tracer.disagreements, tracer.name);
    }
    return text;
}

/// The disagreements of a tracer, and the conclusion.
std::string differences_of(const TracerFigures& tracer, const GatherBenchResult& result) {
    std::string text;
    std::uint64_t lines = 0;
    for (const Disagreement& item : result.disagreements) {
        if (item.tracer == tracer.name && lines < kMaxLines) {
            text += line_of(item);
            ++lines;
        }
    }
    if (tracer.disagreements > lines) {
        text += fmt::format("  {} differs for {} more rays (--json has the first hundred)\n", tracer.name,
                            tracer.disagreements - lines);
    }
    if (tracer.is_wrong && tracer.embree_width != 0) {
        text += fmt::format(
            "Embree contradicts itself: {} differs from rtcOccluded1 for {:.2g} % of the rays. It is "
            "excluded below.\n",
            tracer.name,
            100.0 * static_cast<double>(tracer.disagreements) / static_cast<double>(result.after_culling));
    }
    return text;
}

std::string ratio_line(const TracerFigures& ours, const TracerFigures& embree, const Ratio& wall,
                       const Ratio& processor) {
    std::string text = fmt::format("{} {:.2f} ± {:.2f} times as fast as {}", ours.name, wall.median,
                                   wall.deviation, embree.name);
    if (processor.median > 0.0) {
        text += fmt::format(", {:.2f} ± {:.2f} by processor time", processor.median, processor.deviation);
    }
    return text + "\n";
}

}  // namespace

std::string gather_bench_text(const std::string& name, BvhQuality bvh, const GatherBenchResult& result) {
    std::string text = head(name, bvh, result) + table(result);
    for (const TracerFigures& tracer : result.tracers) {
        text += differences_of(tracer, result);
    }
    text +=
        fmt::format("Hit by hit: {}; a ray within {:.3g} of an edge may go either way.\n",
                    result.agrees ? "ours agree with Embree" : "OURS DO NOT AGREE", result.edge_tolerance);
    text +=
        "Medians of interleaved runs. Our time is that of the whole gather, Embree's only that inside its "
        "calls.\n";
    const std::vector<TracerFigures>& tracers = result.tracers;
    text += ratio_line(tracers[result.ours], tracers[result.embree1], result.wall1, result.processor1);
    text += ratio_line(tracers[result.ours], tracers[result.embree16], result.wall16, result.processor16);
    if (result.roulette) {
        text += ratio_line(tracers[*result.roulette], tracers[result.embree16], result.wall_roulette,
                           result.processor_roulette);
    }
    return text;
}

}  // namespace nearlight::core
