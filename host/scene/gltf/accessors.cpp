// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {
namespace {

/// Numbers in a buffer, checked to lie within it.
struct Elements {
    const unsigned char* data = nullptr;  ///< null if all numbers are zero
    std::size_t stride = 0;               ///< bytes from one element to the next
    int component_type = 0;
    bool normalized = false;
};

std::size_t component_bytes(const GltfFile& file, int component_type) {
    const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type));
    if (bytes <= 0 || component_type == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
        file.fail("an accessor has the unknown component type " + std::to_string(component_type));
    }
    return static_cast<std::size_t>(bytes);
}

/// The elements of a view from `offset` on: `count` with `components` numbers each. With a `stride` of 0 they
/// follow one another.
Elements elements_of(const GltfFile& file, int view_index, std::size_t offset, std::size_t stride,
                     int component_type, std::size_t components, std::size_t count) {
    const std::span<const std::byte> view = bytes_of(file, view_index);
    const std::size_t bytes = components * component_bytes(file, component_type);
    stride = stride == 0 ? bytes : stride;
    const bool in_view = offset <= view.size() && (count == 0 || bytes <= view.size() - offset) &&
                         (count < 2 || (count - 1) <= (view.size() - offset - bytes) / stride);
    if (!in_view) {
        file.fail("an accessor reaches beyond the end of buffer view " + std::to_string(view_index));
    }
    return {reinterpret_cast<const unsigned char*>(view.data()) + offset, stride, component_type};
}

template <typename T>
double component(const unsigned char* at, bool normalized) {
    T value;
    std::memcpy(&value, at, sizeof value);
    const auto number = static_cast<double>(value);
    if constexpr (std::is_floating_point_v<T>) {
        return number;
    }
    return normalized ? std::max(number / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : number;
}

double number(const Elements& elements, std::size_t element, std::size_t index) {
    if (elements.data == nullptr) {
        return 0;
    }
    const unsigned char* const from = elements.data + element * elements.stride;
    switch (elements.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return component<std::int8_t>(from + index, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return component<std::uint8_t>(from + index, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return component<std::int16_t>(from + 2 * index, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return component<std::uint16_t>(from + 2 * index, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_INT:
            return component<std::int32_t>(from + 4 * index, elements.normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return component<std::uint32_t>(from + 4 * index, elements.normalized);
        default:
            return component<float>(from + 4 * index, false);
    }
}

/// The maximum number of elements of an accessor that no bytes bound, so that no small file takes much
/// memory.
constexpr std::size_t kMaxZeros = std::size_t{1} << 24u;

/// The elements of an accessor without its sparse ones; zero without a buffer view.
Elements dense_elements(const GltfFile& file, const tinygltf::Accessor& accessor, std::size_t components) {
    if (accessor.bufferView < 0) {
        if (accessor.count > kMaxZeros) {
            file.fail("an accessor has " + std::to_string(accessor.count) + " elements, but no buffer view");
        }
        return {nullptr, 0, accessor.componentType, false};
    }
    const tinygltf::BufferView& view =
        file.at(file.model.bufferViews, accessor.bufferView, "buffer view", "an accessor");
    Elements elements = elements_of(file, accessor.bufferView, accessor.byteOffset, view.byteStride,
                                    accessor.componentType, components, accessor.count);
    elements.normalized = accessor.normalized;
    return elements;
}

/// Calls visit(element, component, number) for all numbers, then again for those that sparse elements
/// replace.
template <typename Visit>
void for_each_number(const GltfFile& file, const tinygltf::Accessor& accessor, std::size_t components,
                     const Visit& visit) {
    const Elements dense = dense_elements(file, accessor, components);
    for (std::size_t i = 0; i < accessor.count; ++i) {
        for (std::size_t c = 0; c < components; ++c) {
            visit(i, c, number(dense, i, c));
        }
    }
    if (!accessor.sparse.isSparse) {
        return;
    }
    const auto count = static_cast<std::size_t>(std::max(accessor.sparse.count, 0));
    const Elements places = elements_of(file, accessor.sparse.indices.bufferView,
                                        static_cast<std::size_t>(accessor.sparse.indices.byteOffset), 0,
                                        accessor.sparse.indices.componentType, 1, count);
    Elements values = elements_of(file, accessor.sparse.values.bufferView,
                                  static_cast<std::size_t>(accessor.sparse.values.byteOffset), 0,
                                  accessor.componentType, components, count);
    values.normalized = accessor.normalized;
    for (std::size_t i = 0; i < count; ++i) {
        const double place = number(places, i, 0);
        if (!(place >= 0) || !(place < static_cast<double>(accessor.count))) {
            file.fail("a sparse accessor of " + std::to_string(accessor.count) +
                      " elements replaces an element beyond its end");
        }
        for (std::size_t c = 0; c < components; ++c) {
            visit(static_cast<std::size_t>(place), c, number(values, i, c));
        }
    }
}

const tinygltf::Accessor& checked_accessor(const GltfFile& file, int index, int components) {
    const tinygltf::Accessor& accessor = file.at(file.model.accessors, index, "accessor", "the file");
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components) {
        file.fail("accessor " + std::to_string(index) + " does not have " + std::to_string(components) +
                  " numbers per element");
    }
    return accessor;
}

}  // namespace

std::span<const std::byte> bytes_of(const GltfFile& file, int buffer_view) {
    const tinygltf::BufferView& view =
        file.at(file.model.bufferViews, buffer_view, "buffer view", "the file");
    const tinygltf::Buffer& buffer = file.at(file.model.buffers, view.buffer, "buffer", "a buffer view");
    if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset) {
        file.fail("buffer view " + std::to_string(buffer_view) + " reaches beyond the end of its buffer");
    }
    return std::as_bytes(std::span(buffer.data)).subspan(view.byteOffset, view.byteLength);
}

std::vector<float> read_numbers(const GltfFile& file, int accessor_index, int components) {
    const tinygltf::Accessor& accessor = checked_accessor(file, accessor_index, components);
    const auto width = static_cast<std::size_t>(components);
    dense_elements(file, accessor, width);  // fails before memory is taken for elements that do not exist
    std::vector<float> numbers(accessor.count * width);
    for_each_number(file, accessor, width, [&](std::size_t element, std::size_t index, double value) {
        numbers[element * width + index] = static_cast<float>(value);
    });
    return numbers;
}

std::vector<uint> read_indices(const GltfFile& file, int accessor_index) {
    const tinygltf::Accessor& accessor = checked_accessor(file, accessor_index, 1);
    dense_elements(file, accessor, 1);
    std::vector<uint> indices(accessor.count);
    for_each_number(file, accessor, 1, [&](std::size_t element, std::size_t, double value) {
        indices[element] = value >= 0 && value < 0x1p32 ? static_cast<uint>(value) : ~0u;
    });
    return indices;
}

}  // namespace nearlight::core::gltf
