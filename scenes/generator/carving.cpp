// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/carving.h"

namespace nearlight::core::scenes {
namespace {

constexpr int kBlock = 8;        // cells along a side of the blocks that are culled together
constexpr float kSlack = 1.35f;  // how much steeper than 1 a Distance may be
constexpr uint kNoVertex = ~0u;

/// Polynomial smooth minimum: exact where the two differ by more than k.
float smooth_min(float a, float b, float k) {
    const float h = std::max(k - std::abs(a - b), 0.0f) / k;
    return std::min(a, b) - h * h * k * 0.25f;
}

}  // namespace

Distance solid_ellipsoid(Vec3 center, Vec3 radii) {
    return [=](Vec3 p) {
        const Vec3 q = p - center;
        const Vec3 scaled{q.x / radii.x, q.y / radii.y, q.z / radii.z};
        const float k0 = length(scaled);
        const float k1 = length({scaled.x / radii.x, scaled.y / radii.y, scaled.z / radii.z});
        return k1 > 1e-6f ? k0 * (k0 - 1.0f) / k1 : -std::min(radii.x, std::min(radii.y, radii.z));
    };
}

Distance solid_cone(Vec3 a, Vec3 b, float radius_a, float radius_b) {
    const Vec3 axis = b - a;
    const float inverse_length2 = 1.0f / dot(axis, axis);
    return [=](Vec3 p) {
        const float t = std::clamp(dot(p - a, axis) * inverse_length2, 0.0f, 1.0f);
        return length(p - a - axis * t) - (radius_a + (radius_b - radius_a) * t);
    };
}

Distance solid_curl(Vec3 center, Vec3 axis, float radius, float turns) {
    const Vec3 pole = normalize(axis);
    const auto [side, up] = orthonormal_basis(pole);
    return [=, side_ = side, up_ = up](Vec3 p) {
        const Vec3 q = p - center;
        const float distance = length(q);
        if (distance < 1e-5f || distance > 1.6f * radius) {
            return distance - radius;
        }
        const float from_pole = std::acos(std::clamp(dot(q, pole) / distance, -1.0f, 1.0f));
        const float angle = std::atan2(dot(q, up_), dot(q, side_));
        const float wave = std::sin(angle + from_pole * 4.0f * turns);
        const float fade = std::min(1.0f, from_pole * 3.0f);
        return distance - radius * (0.9f + 0.13f * fade * wave);
    };
}

Distance solid_box(Vec3 center, Vec3 half, float rounding) {
    return [=](Vec3 p) {
        const Vec3 d = p - center;
        const Vec3 q =
            Vec3{std::abs(d.x), std::abs(d.y), std::abs(d.z)} - half + Vec3{rounding, rounding, rounding};
        return length(max(q, {0, 0, 0})) + std::min(max_component(q), 0.0f) - rounding;
    };
}

void Carving::add(Distance part, float blend) {
    parts_.push_back({std::move(part), blend, false});
}

void Carving::cut(Distance part, float blend) {
    parts_.push_back({std::move(part), blend, true});
}

void Carving::add_pair(const std::function<Distance(float)>& make, float blend) {
    add(make(1.0f), blend);
    add(make(-1.0f), blend);
}

void Carving::set_roughness(Distance roughness, float reach) {
    roughness_ = std::move(roughness);
    roughness_reach_ = reach;
}

float Carving::distance(Vec3 p, const std::vector<const Part*>& parts) const {
    float result = 1.0f;
    for (const Part* part : parts) {
        const float d = part->distance(p);
        result = part->cuts ? -smooth_min(-result, d, part->blend) : smooth_min(result, d, part->blend);
    }
    return roughness_ && std::abs(result) < 2.0f * roughness_reach_ ? result + roughness_(p) : result;
}

/// Goes through the grid one layer of nodes after the other, so that it holds only two layers in memory.
class CarvingMesher {
  public:
    CarvingMesher(const Carving& carving, const Aabb& box, float cell)
        : carving_(carving), origin_(box.min), cell_(cell) {
        const auto blocks = [&](float extent) { return static_cast<int>(extent / (cell * kBlock)) + 1; };
        const Vec3 size = box.size();
        blocks_x_ = blocks(size.x), blocks_y_ = blocks(size.y), blocks_z_ = blocks(size.z);
        nodes_x_ = blocks_x_ * kBlock, nodes_y_ = blocks_y_ * kBlock;
        for (auto& vertices : cell_vertices_) {
            vertices.assign(static_cast<size_t>(nodes_x_ * nodes_y_), kNoVertex);
        }
        for (auto& values : node_values_) {
            values.assign(static_cast<size_t>(nodes_x_ * nodes_y_), 1.0f);
        }
    }

    Mesh run() {
        for (int z = 0; z < blocks_z_ * kBlock; ++z) {
            if (z % kBlock == 0) {
                cull(z / kBlock);
            }
            std::swap(node_values_[0], node_values_[1]);
            evaluate(z);
            if (z > 0) {
                std::swap(cell_vertices_[0], cell_vertices_[1]);
                place_vertices(z - 1);
                connect();
            }
        }
        return std::move(mesh_);
    }

  private:
    struct Block {
        float fallback = 1.0f;  // distance where the surface is far away
        std::vector<const Carving::Part*> parts;
    };

    [[nodiscard]] Vec3 node(int x, int y, int z) const {
        return origin_ + Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * cell_;
    }
    [[nodiscard]] size_t at(int x, int y) const { return static_cast<size_t>(y * nodes_x_ + x); }

    void cull(int block_z) {
        const float half_diagonal = 0.87f * kBlock * cell_;
        std::vector<const Carving::Part*> all;
        for (const Carving::Part& part : carving_.parts_) {
            all.push_back(&part);
        }
        layer_.assign(static_cast<size_t>(blocks_x_ * blocks_y_), {});
        for (int y = 0; y < blocks_y_; ++y) {
            for (int x = 0; x < blocks_x_; ++x) {
                Block& block = layer_[static_cast<size_t>(y * blocks_x_ + x)];
                const float half = 0.5f * kBlock;
                const Vec3 center =
                    node(x * kBlock, y * kBlock, block_z * kBlock) + Vec3{half, half, half} * cell_;
                block.fallback = carving_.distance(center, all);
                const float near = kSlack * (half_diagonal + cell_) + carving_.roughness_reach_;
                if (std::abs(block.fallback) > 2.0f * near) {
                    continue;
                }
                for (const Carving::Part* part : all) {
                    if (part->distance(center) < near + part->blend) {
                        block.parts.push_back(part);
                    }
                }
            }
        }
    }

    void evaluate(int z) {
        for (int y = 0; y < nodes_y_; ++y) {
            for (int x = 0; x < nodes_x_; ++x) {
                const Block& block = layer_[static_cast<size_t>((y / kBlock) * blocks_x_ + x / kBlock)];
                node_values_[1][at(x, y)] =
                    block.parts.empty() ? block.fallback : carving_.distance(node(x, y, z), block.parts);
            }
        }
    }

    [[nodiscard]] float value(int x, int y, int dz) const {
        return node_values_[static_cast<size_t>(dz)][at(x, y)];
    }

    /// Places one vertex in each cell that the surface crosses, at the mean of the crossings of its edges.
    void place_vertices(int z) {
        for (int y = 0; y + 1 < nodes_y_; ++y) {
            for (int x = 0; x + 1 < nodes_x_; ++x) {
                cell_vertices_[1][at(x, y)] = place_vertex(x, y, z);
            }
        }
    }

    uint place_vertex(int x, int y, int z) {
        float corner[8];
        int inside = 0;
        for (int i = 0; i < 8; ++i) {
            corner[i] = value(x + (i & 1), y + ((i >> 1) & 1), i >> 2);
            inside += corner[i] < 0.0f ? 1 : 0;
        }
        if (inside == 0 || inside == 8) {
            return kNoVertex;
        }
        Vec3 sum{0, 0, 0}, gradient{0, 0, 0};
        float crossings = 0.0f;
        for (int i = 0; i < 8; ++i) {
            for (int bit = 1; bit < 8; bit <<= 1) {
                const int j = i | bit;
                if (j == i) {
                    continue;
                }
                const float step = corner[j] - corner[i];
                gradient += Vec3{bit == 1 ? step : 0.0f, bit == 2 ? step : 0.0f, bit == 4 ? step : 0.0f};
                if ((corner[i] < 0.0f) != (corner[j] < 0.0f)) {
                    const float t = corner[i] / (corner[i] - corner[j]);
                    sum += corner_offset(i) * (1.0f - t) + corner_offset(j) * t;
                    crossings += 1.0f;
                }
            }
        }
        return mesh_.add_vertex(node(x, y, z) + sum * (cell_ / crossings), normalize(gradient));
    }

    static Vec3 corner_offset(int i) {
        return {static_cast<float>(i & 1), static_cast<float>((i >> 1) & 1), static_cast<float>(i >> 2)};
    }

    /// Adds a quad across each edge that the surface crosses, from the vertices of the four cells around the
    /// edge.
    void connect() {
        const auto& back = cell_vertices_[0];
        const auto& front = cell_vertices_[1];
        for (int y = 1; y < nodes_y_; ++y) {
            for (int x = 1; x < nodes_x_; ++x) {
                const float here = value(x, y, 0);
                if (x + 1 < nodes_x_) {
                    across(here, value(x + 1, y, 0),
                           {back[at(x, y - 1)], back[at(x, y)], front[at(x, y)], front[at(x, y - 1)]});
                }
                if (y + 1 < nodes_y_) {
                    across(here, value(x, y + 1, 0),
                           {back[at(x - 1, y)], front[at(x - 1, y)], front[at(x, y)], back[at(x, y)]});
                }
                across(here, value(x, y, 1),
                       {front[at(x - 1, y - 1)], front[at(x, y - 1)], front[at(x, y)], front[at(x - 1, y)]});
            }
        }
    }

    void across(float from, float to, const std::array<uint, 4>& ring) {
        if ((from < 0.0f) == (to < 0.0f)) {
            return;
        }
        if (from < 0.0f) {
            mesh_.add_quad(ring[0], ring[1], ring[2], ring[3]);
        } else {
            mesh_.add_quad(ring[3], ring[2], ring[1], ring[0]);
        }
    }

    const Carving& carving_;
    Vec3 origin_;
    float cell_;
    int blocks_x_ = 0, blocks_y_ = 0, blocks_z_ = 0, nodes_x_ = 0, nodes_y_ = 0;
    std::vector<Block> layer_;
    std::array<std::vector<float>, 2> node_values_;   // layers z and z + 1
    std::array<std::vector<uint>, 2> cell_vertices_;  // vertices of the cells below layer z and above it
    Mesh mesh_;
};

Mesh Carving::mesh(const Aabb& box, float cell) const {
    return CarvingMesher(*this, box, cell).run();
}

}  // namespace nearlight::core::scenes
