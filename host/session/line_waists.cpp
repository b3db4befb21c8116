// SPDX-License-Identifier: Apache-2.0
#include "host/session/line_waists.h"

#include <algorithm>
#include <optional>

namespace nearlight::core {
namespace {

constexpr std::size_t kMinGroup = 24;
constexpr int kBeginnings = 12;  ///< ways to begin that are tried
constexpr int kFits = 8;         ///< of centres to the lines that are assigned to them
constexpr double kPartInside = 0.85;
/// How much the mean of the origins attracts a centre, compared with the half lines. Parallel ones do not
/// tell how far along them they pass.
constexpr double kPullOfOrigins = 0.001;
/// Half lines nearer to a centre than this part of the distance to their origins weigh alike in its fit.
constexpr double kAlikeWithin = 0.05;

/// A symmetric system of three linear equations, M·x = b.
struct SymmetricSystem {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    double bx = 0, by = 0, bz = 0;

    /// Adds weight · (1 − part · d·dᵀ) · (x − p) = 0.
    void add(double weight, double part, Vec3 d, Vec3 p) {
        const double mxx = weight * (1 - part * d.x * d.x), mxy = -weight * part * d.x * d.y;
        const double mxz = -weight * part * d.x * d.z, myy = weight * (1 - part * d.y * d.y);
        const double myz = -weight * part * d.y * d.z, mzz = weight * (1 - part * d.z * d.z);
        xx += mxx, xy += mxy, xz += mxz, yy += myy, yz += myz, zz += mzz;
        bx += mxx * p.x + mxy * p.y + mxz * p.z;
        by += mxy * p.x + myy * p.y + myz * p.z;
        bz += mxz * p.x + myz * p.y + mzz * p.z;
    }

    /// By Cramer's rule; M must be positive definite.
    [[nodiscard]] Vec3 solution() const {
        const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
        const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
        const double determinant = xx * cxx + xy * cxy + xz * cxz;
        return {static_cast<float>((cxx * bx + cxy * by + cxz * bz) / determinant),
                static_cast<float>((cxy * bx + cyy * by + cyz * bz) / determinant),
                static_cast<float>((cxz * bx + cyz * by + czz * bz) / determinant)};
    }
};

/// The point to which the sum of the distances is about the least, from a point near it: a step of
/// iteratively reweighted least squares. A few stray half lines hardly move it, unlike the least sum of
/// squares.
Vec3 fit_center(std::span<const HalfLine> lines, std::span<const std::size_t> group,
                const std::optional<Vec3>& near) {
    SymmetricSystem system;
    double weights = 0;
    Vec3 origins{0, 0, 0};
    for (const std::size_t i : group) {
        double weight = 1.0;
        if (near) {
            const double alike = kAlikeWithin * static_cast<double>(length(lines[i].origin - *near));
            weight = 1 / (static_cast<double>(distance_to(lines[i], *near)) + alike + 1e-30);
        }
        system.add(weight, 1.0, lines[i].direction, lines[i].origin);
        weights += weight;
        origins += lines[i].origin;
    }
    system.add(kPullOfOrigins * weights, 0.0, {0, 0, 0}, origins / static_cast<float>(group.size()));
    return system.solution();
}

/// A division of half lines into groups by their nearest centre.
struct Division {
    std::vector<Vec3> centers;
    std::vector<std::vector<std::size_t>> groups;  ///< one for each centre
    double distances = 0;                          ///< the sum of all to their centres
};

Division divide(std::span<const HalfLine> lines, std::vector<Vec3> centers) {
    Division division{.centers = std::move(centers), .groups = {}, .distances = 0};
    division.groups.resize(division.centers.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::size_t nearest = 0;
        float least = kInfinity;
        for (std::size_t k = 0; k < division.centers.size(); ++k) {
            const float distance = distance_to(lines[i], division.centers[k]);
            if (distance < least) {
                least = distance;
                nearest = k;
            }
        }
        division.groups[nearest].push_back(i);
        division.distances += least;
    }
    return division;
}

/// Moves each centre to the middle of its group, and drops those of groups that are too small.
std::vector<Vec3> moved_centers(std::span<const HalfLine> lines, const Division& division) {
    std::vector<Vec3> centers;
    for (std::size_t k = 0; k < division.centers.size(); ++k) {
        if (division.groups[k].size() >= kMinGroup) {
            centers.push_back(fit_center(lines, division.groups[k], division.centers[k]));
        }
    }
    return centers;
}

/// Each centre begins where two half lines that are chosen by chance come closest.
std::vector<Vec3> first_centers(std::span<const HalfLine> lines, std::size_t count, Pcg32& random) {
    std::vector<Vec3> centers;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t pair[] = {random.next() % lines.size(), random.next() % lines.size()};
        centers.push_back(fit_center(lines, pair, {}));
    }
    return centers;
}

Waist waist_of(std::span<const HalfLine> lines, Vec3 center, std::span<const std::size_t> group) {
    Waist waist{.center = center, .radius = 0, .direction = {0, 0, 0}, .share = 0};
    std::vector<float> distances;
    for (const std::size_t i : group) {
        distances.push_back(distance_to(lines[i], center));
        waist.direction += lines[i].direction;
    }
    const auto inside = distances.begin() +
                        static_cast<std::ptrdiff_t>(kPartInside * static_cast<double>(distances.size() - 1));
    std::ranges::nth_element(distances, inside);
    waist.radius = *inside;
    waist.direction = normalize(waist.direction);
    waist.share = static_cast<float>(group.size()) / static_cast<float>(lines.size());
    return waist;
}

}  // namespace

float distance_to(const HalfLine& line, Vec3 point) {
    const Vec3 way = point - line.origin;
    return length(way - line.direction * std::max(dot(way, line.direction), 0.0f));
}

std::vector<Waist> find_waists(std::span<const HalfLine> lines, std::size_t max_count, Pcg32 random) {
    if (lines.size() < kMinGroup) {
        return {};
    }
    Division best;
    for (int beginning = 0; beginning < kBeginnings; ++beginning) {
        const std::size_t count = std::min(max_count, lines.size() / kMinGroup);
        Division division = divide(lines, first_centers(lines, count, random));
        for (int fit = 0; fit < kFits; ++fit) {
            std::vector<Vec3> centers = moved_centers(lines, division);
            if (centers.empty()) {
                break;
            }
            division = divide(lines, std::move(centers));
        }
        if (best.centers.empty() || division.distances < best.distances) {
            best = std::move(division);
        }
    }
    std::vector<Waist> waists;
    for (std::size_t k = 0; k < best.centers.size(); ++k) {
        if (best.groups[k].size() >= kMinGroup) {
            waists.push_back(waist_of(lines, best.centers[k], best.groups[k]));
        }
    }
    return waists;
}

}  // namespace nearlight::core
