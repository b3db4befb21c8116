// SPDX-License-Identifier: Apache-2.0
#include "host/base/math.h"

#include <stdexcept>
#include <utility>

namespace nearlight::core {

Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 product;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            double sum = 0;
            for (int i = 0; i < 4; ++i) {
                sum += a(row, i) * b(i, column);
            }
            product(row, column) = sum;
        }
    }
    return product;
}

// Gauss-Jordan elimination with partial pivoting.
Mat4 inverse(const Mat4& a) {
    Mat4 left = a;
    Mat4 right;
    for (int column = 0; column < 4; ++column) {
        int pivot = column;
        for (int row = column + 1; row < 4; ++row) {
            if (std::abs(left(row, column)) > std::abs(left(pivot, column))) {
                pivot = row;
            }
        }
        if (!(std::abs(left(pivot, column)) > 1e-300)) {
            throw std::domain_error("matrix has no inverse");
        }
        for (int i = 0; i < 4; ++i) {
            std::swap(left(column, i), left(pivot, i));
            std::swap(right(column, i), right(pivot, i));
        }
        const double scale = 1.0 / left(column, column);
        for (int i = 0; i < 4; ++i) {
            left(column, i) *= scale;
            right(column, i) *= scale;
        }
        for (int row = 0; row < 4; ++row) {
            const double factor = left(row, column);
            if (row == column || factor == 0.0) {
                continue;
            }
            for (int i = 0; i < 4; ++i) {
                left(row, i) -= factor * left(column, i);
                right(row, i) -= factor * right(column, i);
            }
        }
    }
    return right;
}

double linear_determinant(const Mat4& a) {
    return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) -
           a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
           a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

Vec3 transform_point(const Mat4& a, Vec3 p) {
    const auto row = [&](int r) { return a(r, 0) * p.x + a(r, 1) * p.y + a(r, 2) * p.z + a(r, 3); };
    const double w = row(3);
    return {static_cast<float>(row(0) / w), static_cast<float>(row(1) / w), static_cast<float>(row(2) / w)};
}

Vec3 transform_vector(const Mat4& a, Vec3 v) {
    const auto row = [&](int r) { return static_cast<float>(a(r, 0) * v.x + a(r, 1) * v.y + a(r, 2) * v.z); };
    return {row(0), row(1), row(2)};
}

Vec3 transform_normal_by_inverse(const Mat4& inverse, Vec3 n) {
    const auto column = [&](int c) {
        return static_cast<float>(inverse(0, c) * n.x + inverse(1, c) * n.y + inverse(2, c) * n.z);
    };
    return {column(0), column(1), column(2)};
}

Mat4 translation(double x, double y, double z) {
    return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1}};
}

Mat4 scaling(double x, double y, double z) {
    return {{x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}};
}

Mat4 rotation(double axis_x, double axis_y, double axis_z, double degrees) {
    const double norm = std::sqrt(axis_x * axis_x + axis_y * axis_y + axis_z * axis_z);
    if (norm == 0.0) {
        return {};
    }
    return rodrigues(axis_x / norm, axis_y / norm, axis_z / norm, degrees);
}

Mat4 rodrigues(double x, double y, double z, double degrees) {
    const double c = std::cos(degrees * std::numbers::pi / 180.0);
    const double s = std::sin(degrees * std::numbers::pi / 180.0);
    const double t = 1.0 - c;
    return {{t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0,  //
             t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0,  //
             t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0,  //
             0, 0, 0, 1}};
}

Mat4 look_at(std::array<double, 3> origin, std::array<double, 3> target, std::array<double, 3> up) {
    using V = std::array<double, 3>;
    const auto unit = [](V v) {
        const double l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        return l > 0 ? V{v[0] / l, v[1] / l, v[2] / l} : v;
    };
    const auto crossed = [](V a, V b) {
        return V{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const V forward = unit({target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
    const V left = unit(crossed(up, forward));
    const V true_up = crossed(forward, left);
    return {{left[0], true_up[0], forward[0], origin[0],  //
             left[1], true_up[1], forward[1], origin[1],  //
             left[2], true_up[2], forward[2], origin[2],  //
             0, 0, 0, 1}};
}

}  // namespace nearlight::core
