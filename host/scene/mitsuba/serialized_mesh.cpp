// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/serialized_mesh.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "host/scene/file_text.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in the file");

constexpr std::uint16_t kMagic = 0x041c;
constexpr std::size_t kHeaderSize = 4;  // magic number and version

// Flags of versions 3 and 4.
constexpr std::uint32_t kHasNormals = 1;
constexpr std::uint32_t kHasUvs = 2;
constexpr std::uint32_t kHasColors = 8;
constexpr std::uint32_t kDoublePrecision = 0x2000;
// Flags of version 5.
constexpr std::uint32_t kPackedNormals = 1;
constexpr std::uint32_t kPackedTangents = 2;
constexpr std::uint32_t kPackedUvs = 4;
constexpr std::uint32_t kPackedFaceNormals = 0x10;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw Error(ErrorKind::file, file.string() + ": " + what);
}

/// Reads numbers from bytes, one after another.
class ByteReader {
  public:
    ByteReader(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    template <typename T>
    std::vector<T> array(std::uint64_t count) {
        if (count > bytes_.size() / sizeof(T)) {
            refuse(file_, "the file is truncated");
        }
        std::vector<T> values(static_cast<std::size_t>(count));
        if (count > 0) {
            std::memcpy(values.data(), bytes_.data(), values.size() * sizeof(T));
        }
        bytes_.remove_prefix(values.size() * sizeof(T));
        return values;
    }
    template <typename T>
    T number() {
        return array<T>(1)[0];
    }
    void skip_terminated_text() {
        while (number<char>() != '\0') {}
    }

  private:
    const std::filesystem::path& file_;
    std::string_view bytes_;
};

/// Decompresses the zlib stream at the beginning of the bytes.
std::string inflate_stream(const std::filesystem::path& file, std::string_view bytes) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) {
        throw Error(ErrorKind::out_of_memory, file.string() + ": no memory to decompress this file");
    }
    std::string result;
    std::string chunk(std::size_t{1} << 18, '\0');
    int status = Z_OK;
    while (status == Z_OK) {
        // zlib counts in 32 bits, and takes the input without changing it.
        if (stream.avail_in == 0 && !bytes.empty()) {
            const std::size_t part = std::min<std::size_t>(bytes.size(), 1u << 30);
            stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
            stream.avail_in = static_cast<uInt>(part);
            bytes.remove_prefix(part);
        }
        stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
        stream.avail_out = static_cast<uInt>(chunk.size());
        status = inflate(&stream, Z_NO_FLUSH);
        result.append(chunk.data(), chunk.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) {
        refuse(file, "the compressed data is broken or truncated");
    }
    return result;
}

/// The number at `place` bytes from the start of the file.
template <typename T>
T number_at(const std::filesystem::path& file, std::string_view bytes, std::uint64_t place) {
    if (place > bytes.size()) {
        refuse(file, "the file is truncated");
    }
    return ByteReader(file, bytes.substr(static_cast<std::size_t>(place))).number<T>();
}

/// Where the mesh begins, by the dictionary at the end of the file.
std::uint64_t offset_of(const std::filesystem::path& file, std::string_view bytes, int version, int index) {
    if (index == 0) {
        return 0;
    }
    const auto count = number_at<std::uint32_t>(file, bytes, bytes.size() - sizeof(std::uint32_t));
    if (index < 0 || static_cast<std::uint32_t>(index) >= count) {
        refuse(file, "has " + std::to_string(count) + " meshes, and no mesh with the index " +
                         std::to_string(index));
    }
    const std::uint64_t behind = count - static_cast<std::uint32_t>(index);
    const std::uint64_t entry = version == 3 ? sizeof(std::uint32_t) : sizeof(std::uint64_t);
    const std::uint64_t from_end = entry * behind + sizeof(std::uint32_t);
    if (from_end > bytes.size()) {
        refuse(file, "the file is truncated");
    }
    const std::uint64_t place = bytes.size() - from_end;
    return version == 3 ? number_at<std::uint32_t>(file, bytes, place)
                        : number_at<std::uint64_t>(file, bytes, place);
}

std::vector<float> floats(ByteReader& reader, std::uint64_t count, bool is_double) {
    if (!is_double) {
        return reader.array<float>(count);
    }
    const std::vector<double> values = reader.array<double>(count);
    return {values.begin(), values.end()};
}

std::vector<Vec3> vectors(std::span<const float> values) {
    std::vector<Vec3> result;
    result.reserve(values.size() / 3);
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        result.push_back({values[i], values[i + 1], values[i + 2]});
    }
    return result;
}

/// Vertices must be fewer than indices can count, and a count that is out of all bounds must not overflow.
void check_counts(const std::filesystem::path& file, std::uint64_t vertices, std::uint64_t faces) {
    if (std::max(vertices, faces) > 0xffffffffu) {
        refuse(file, "has more vertices or triangles than can be counted");
    }
}

Mesh read_arrays(const std::filesystem::path& file, ByteReader& reader, int version) {
    const auto flags = reader.number<std::uint32_t>();
    if (version == 4) {
        reader.skip_terminated_text();
    }
    const auto vertex_count = reader.number<std::uint64_t>();
    const auto face_count = reader.number<std::uint64_t>();
    check_counts(file, vertex_count, face_count);
    const bool is_double = (flags & kDoublePrecision) != 0;
    Mesh mesh;
    mesh.positions = vectors(floats(reader, 3 * vertex_count, is_double));
    if ((flags & kHasNormals) != 0) {
        mesh.normals = vectors(floats(reader, 3 * vertex_count, is_double));
    }
    if ((flags & kHasUvs) != 0) {
        const std::vector<float> uvs = floats(reader, 2 * vertex_count, is_double);
        for (std::size_t i = 0; i < uvs.size(); i += 2) {
            mesh.uvs.push_back({uvs[i], uvs[i + 1]});
        }
    }
    if ((flags & kHasColors) != 0) {
        static_cast<void>(floats(reader, 3 * vertex_count, is_double));
    }
    const std::vector<std::uint32_t> indices = reader.array<std::uint32_t>(3 * face_count);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return mesh;
}

/// Version 5 has records of eight floats a vertex (position, normal, texture coordinates) and four words a
/// triangle.
Mesh read_records(const std::filesystem::path& file, ByteReader& reader) {
    const auto flags = reader.number<std::uint32_t>();
    if ((flags & kPackedTangents) != 0) {
        refuse(file, "stores shading frames in its vertices, which cannot be read; save it without tangents");
    }
    static_cast<void>(reader.array<char>(reader.number<std::uint32_t>()));  // the name
    const auto vertex_count = reader.number<std::uint64_t>();
    const auto face_count = reader.number<std::uint64_t>();
    check_counts(file, vertex_count, face_count);
    static_cast<void>(reader.array<std::uint64_t>(2));  // surface points and groups of normals
    Mesh mesh;
    mesh.face_normals = (flags & kPackedFaceNormals) != 0;
    const std::vector<float> vertices = reader.array<float>(8 * vertex_count);
    for (std::size_t i = 0; i < vertices.size(); i += 8) {
        mesh.positions.push_back({vertices[i], vertices[i + 1], vertices[i + 2]});
        if ((flags & kPackedNormals) != 0) {
            mesh.normals.push_back({vertices[i + 3], vertices[i + 4], vertices[i + 5]});
        }
        if ((flags & kPackedUvs) != 0) {
            mesh.uvs.push_back({vertices[i + 6], vertices[i + 7]});
        }
    }
    const std::vector<std::uint32_t> faces = reader.array<std::uint32_t>(4 * face_count);
    for (std::size_t i = 0; i < faces.size(); i += 4) {
        mesh.triangles.push_back({faces[i], faces[i + 1], faces[i + 2]});
    }
    return mesh;
}

}  // namespace

Mesh read_serialized(const std::filesystem::path& file, int index) {
    const std::string text = read_file_text(file);
    ByteReader header(file, text);
    if (header.number<std::uint16_t>() != kMagic) {
        refuse(file, "is not a serialized mesh of Mitsuba");
    }
    const int version = header.number<std::uint16_t>();
    if (version < 3 || version > 5) {
        refuse(file, "has the version " + std::to_string(version) + "; known ones are 3, 4 and 5");
    }
    const std::uint64_t begin = offset_of(file, text, version, index) + kHeaderSize;
    if (begin > text.size()) {
        refuse(file, "the file is truncated");
    }
    const std::string data =
        inflate_stream(file, std::string_view(text).substr(static_cast<std::size_t>(begin)));
    ByteReader reader(file, data);
    Mesh mesh = version == 5 ? read_records(file, reader) : read_arrays(file, reader, version);
    if (mesh.triangles.empty()) {
        refuse(file, "has no triangles");
    }
    mesh.source = file;
    return mesh;
}

}  // namespace nearlight::core::mitsuba
