// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/serialized_mesh.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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
constexpr std::uint32_t kFaceNormals = 0x10;
constexpr std::uint32_t kDoublePrecision = 0x2000;
// Flags of version 5.
constexpr std::uint32_t kPackedNormals = 1;
constexpr std::uint32_t kPackedTangents = 2;
constexpr std::uint32_t kPackedUvs = 4;
constexpr std::uint32_t kPackedFaceNormals = 0x10;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw Error(ErrorKind::file, file.string() + ": " + what);
}

/// Decompresses the zlib stream that begins at a place of the file, no further than it is asked for: neither
/// a file of many meshes nor a small one that would fill the memory is read as a whole.
class InflatingReader {
  public:
    InflatingReader(const std::filesystem::path& path, FileParts& file, std::uint64_t begin)
        : path_(path), file_(file), next_(begin) {
        if (inflateInit(&stream_) != Z_OK) {
            throw Error(ErrorKind::out_of_memory, path.string() + ": no memory to decompress this file");
        }
    }
    ~InflatingReader() { inflateEnd(&stream_); }
    InflatingReader(const InflatingReader&) = delete;
    InflatingReader& operator=(const InflatingReader&) = delete;

    /// Takes memory as the numbers come, because a broken file may promise any count of them.
    template <typename T>
    std::vector<T> array(std::uint64_t count) {
        std::vector<T> values;
        while (values.size() < count) {
            const std::size_t before = values.size();
            const std::uint64_t part = std::min<std::uint64_t>(count - before, kStep / sizeof(T));
            values.resize(before + static_cast<std::size_t>(part));
            take(reinterpret_cast<char*>(values.data() + before), (values.size() - before) * sizeof(T));
        }
        return values;
    }
    template <typename T>
    T number() {
        T value;
        take(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }
    void skip_terminated_text() {
        while (number<char>() != '\0') {}
    }
    void skip(std::uint64_t bytes) {
        for (; bytes > 0; --bytes) {
            static_cast<void>(number<char>());
        }
    }
    /// Refuses a stream whose checksum is wrong or missing. What follows the mesh in its stream is left
    /// alone.
    void finish() {
        if (inflated_.empty()) {
            inflate_more();
        }
    }

  private:
    static constexpr std::size_t kStep = std::size_t{1} << 18;

    void take(char* target, std::size_t bytes) {
        while (bytes > 0) {
            if (inflated_.empty() && !inflate_more()) {
                refuse(path_, "the file is truncated");
            }
            const std::size_t part = std::min(bytes, inflated_.size());
            std::memcpy(target, inflated_.data(), part);
            inflated_.remove_prefix(part);
            target += part;
            bytes -= part;
        }
    }
    /// Whether there are more bytes.
    bool inflate_more() {
        std::size_t count = 0;
        while (status_ == Z_OK && count == 0) {
            if (stream_.avail_in == 0) {
                compressed_ = file_.read(next_, kStep);
                next_ += compressed_.size();
                stream_.next_in = reinterpret_cast<Bytef*>(compressed_.data());
                stream_.avail_in = static_cast<uInt>(compressed_.size());
            }
            stream_.next_out = reinterpret_cast<Bytef*>(chunk_.data());
            stream_.avail_out = static_cast<uInt>(chunk_.size());
            status_ = inflate(&stream_, Z_NO_FLUSH);
            count = chunk_.size() - stream_.avail_out;
        }
        if (status_ != Z_OK && status_ != Z_STREAM_END) {
            refuse(path_, "the compressed data is broken or truncated");
        }
        inflated_ = std::string_view(chunk_).substr(0, count);
        return count > 0;
    }

    const std::filesystem::path& path_;
    FileParts& file_;
    std::uint64_t next_;  ///< where the rest of the file begins
    z_stream stream_{};
    int status_ = Z_OK;
    std::string compressed_;
    std::string chunk_ = std::string(kStep, '\0');
    std::string_view inflated_;  ///< what nobody has taken of the chunk
};

/// The number at `place` bytes from the start of the file.
template <typename T>
T number_at(const std::filesystem::path& path, FileParts& file, std::uint64_t place) {
    const std::string bytes = file.read(place, sizeof(T));
    if (bytes.size() < sizeof(T)) {
        refuse(path, "the file is truncated");
    }
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

/// Where the mesh begins, by the dictionary at the end of the file.
std::uint64_t offset_of(const std::filesystem::path& path, FileParts& file, int version, int index) {
    if (index == 0) {
        return 0;
    }
    const auto count = number_at<std::uint32_t>(path, file, file.size() - sizeof(std::uint32_t));
    if (index < 0 || static_cast<std::uint32_t>(index) >= count) {
        refuse(path, "has " + std::to_string(count) + " meshes, and no mesh with the index " +
                         std::to_string(index));
    }
    const std::uint64_t behind = count - static_cast<std::uint32_t>(index);
    const std::uint64_t entry = version == 3 ? sizeof(std::uint32_t) : sizeof(std::uint64_t);
    const std::uint64_t from_end = entry * behind + sizeof(std::uint32_t);
    if (from_end > file.size()) {
        refuse(path, "the file is truncated");
    }
    const std::uint64_t place = file.size() - from_end;
    return version == 3 ? number_at<std::uint32_t>(path, file, place)
                        : number_at<std::uint64_t>(path, file, place);
}

std::vector<float> floats(InflatingReader& reader, std::uint64_t count, bool is_double) {
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

Mesh read_arrays(const std::filesystem::path& file, InflatingReader& reader, int version) {
    const auto flags = reader.number<std::uint32_t>();
    if (version == 4) {
        reader.skip_terminated_text();
    }
    const auto vertex_count = reader.number<std::uint64_t>();
    const auto face_count = reader.number<std::uint64_t>();
    check_counts(file, vertex_count, face_count);
    const bool is_double = (flags & kDoublePrecision) != 0;
    Mesh mesh;
    mesh.face_normals = (flags & kFaceNormals) != 0;
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
        mesh.colors = vectors(floats(reader, 3 * vertex_count, is_double));
    }
    const std::vector<std::uint32_t> indices = reader.array<std::uint32_t>(3 * face_count);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return mesh;
}

/// Version 5 has records of eight floats a vertex (position, normal, texture coordinates) and four words a
/// triangle.
Mesh read_records(const std::filesystem::path& file, InflatingReader& reader) {
    const auto flags = reader.number<std::uint32_t>();
    if ((flags & kPackedTangents) != 0) {
        refuse(file, "stores shading frames in its vertices, which cannot be read; save it without tangents");
    }
    reader.skip(reader.number<std::uint32_t>());  // the name
    const auto vertex_count = reader.number<std::uint64_t>();
    const auto face_count = reader.number<std::uint64_t>();
    check_counts(file, vertex_count, face_count);
    reader.skip(2 * sizeof(std::uint64_t));  // the counts of surface points and groups of normals
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

Mesh read_serialized(const std::filesystem::path& path, int index) {
    FileParts file(path);
    if (number_at<std::uint16_t>(path, file, 0) != kMagic) {
        refuse(path, "is not a serialized mesh of Mitsuba");
    }
    const int version = number_at<std::uint16_t>(path, file, sizeof kMagic);
    if (version < 3 || version > 5) {
        refuse(path, "has the version " + std::to_string(version) + "; known ones are 3, 4 and 5");
    }
    const std::uint64_t begin = offset_of(path, file, version, index) + kHeaderSize;
    if (begin < kHeaderSize || begin > file.size()) {
        refuse(path, "the file is truncated");
    }
    InflatingReader reader(path, file, begin);
    Mesh mesh = version == 5 ? read_records(path, reader) : read_arrays(path, reader, version);
    reader.finish();
    if (mesh.triangles.empty()) {
        refuse(path, "has no triangles");
    }
    mesh.source = path;
    return mesh;
}

}  // namespace nearlight::core::mitsuba
