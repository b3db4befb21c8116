// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_loader.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <sstream>
#include <string_view>

#include "host/scene/file_text.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Format { ascii, little, big };

struct PlyProperty {
    std::string name;
    Scalar type = Scalar::f32;
    bool is_list = false;
    Scalar count_type = Scalar::u8;
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    Format format = Format::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  // bytes
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
    throw Error(ErrorKind::file, file.string() + ": " + what);
}

Scalar parse_scalar(const std::filesystem::path& file, std::string_view name) {
    constexpr std::pair<std::string_view, Scalar> kNames[] = {
        {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
        {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
        {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
        {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64}};
    for (const auto& [known, type] : kNames) {
        if (known == name) {
            return type;
        }
    }
    fail(file, "PLY header has the unknown type '" + std::string(name) + "'");
}

void parse_header_line(const std::filesystem::path& file, const std::string& line, PlyHeader& header) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") {
        std::string format;
        words >> format;
        header.format =
            format == "ascii"                  ? Format::ascii
            : format == "binary_little_endian" ? Format::little
            : format == "binary_big_endian"
                ? Format::big
                : (fail(file, "PLY header has the unknown format '" + format + "'"), Format::ascii);
    } else if (keyword == "element") {
        PlyElement element;
        if (!(words >> element.name >> element.count)) {
            fail(file, "PLY header has a broken line: " + line);
        }
        header.elements.push_back(element);
    } else if (keyword == "property") {
        PlyProperty property;
        std::string type;
        words >> type;
        if (type == "list") {
            std::string count_type;
            words >> count_type >> type;
            property.is_list = true;
            property.count_type = parse_scalar(file, count_type);
        }
        property.type = parse_scalar(file, type);
        if (!(words >> property.name) || header.elements.empty()) {
            fail(file, "PLY header has a broken line: " + line);
        }
        header.elements.back().properties.push_back(property);
    }
}

PlyHeader parse_header(const std::filesystem::path& file, std::string_view text) {
    if (!text.starts_with("ply")) {
        fail(file, "not a PLY file");
    }
    PlyHeader header;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string_view::npos) {
            break;
        }
        std::string line(text.substr(begin, end - begin));
        if (!line.empty() && line.back() == '\r') {
            line.pop_back();
        }
        begin = end + 1;
        if (line == "end_header") {
            header.size = begin;
            return header;
        }
        parse_header_line(file, line, header);
    }
    fail(file, "PLY header is truncated");
}

// Reads one number after the other, whatever the format.
class PlyReader {
  public:
    PlyReader(const std::filesystem::path& file, std::string_view data, Format format)
        : file_(file), data_(data), format_(format) {}

    double read(Scalar type) {
        if (format_ == Format::ascii) {
            return read_word();
        }
        switch (type) {
            case Scalar::i8:
                return read_binary<std::int8_t>();
            case Scalar::u8:
                return read_binary<std::uint8_t>();
            case Scalar::i16:
                return read_binary<std::int16_t>();
            case Scalar::u16:
                return read_binary<std::uint16_t>();
            case Scalar::i32:
                return read_binary<std::int32_t>();
            case Scalar::u32:
                return read_binary<std::uint32_t>();
            case Scalar::f32:
                return static_cast<double>(read_binary<float>());
            case Scalar::f64:
                return read_binary<double>();
        }
        return 0.0;
    }
    [[nodiscard]] std::size_t bytes_left() const { return data_.size(); }

  private:
    template <typename T>
    T read_binary() {
        if (data_.size() < sizeof(T)) {
            fail(file_, "PLY file is truncated");
        }
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), data_.data(), sizeof(T));
        data_.remove_prefix(sizeof(T));
        if ((format_ == Format::big) != (std::endian::native == std::endian::big)) {
            std::reverse(bytes.begin(), bytes.end());
        }
        return std::bit_cast<T>(bytes);
    }
    double read_word() {
        data_.remove_prefix(std::min(data_.find_first_not_of(" \t\r\n"), data_.size()));
        if (data_.empty()) {
            fail(file_, "PLY file is truncated");
        }
        double value = 0.0;
        const auto [end, error] = std::from_chars(data_.data(), data_.data() + data_.size(), value);
        if (error != std::errc()) {
            fail(file_, "PLY file has '" + std::string(data_.substr(0, data_.find_first_of(" \t\r\n"))) +
                            "' where a number should be");
        }
        data_.remove_prefix(static_cast<std::size_t>(end - data_.data()));
        return value;
    }

    const std::filesystem::path& file_;
    std::string_view data_;
    Format format_;
};

void skip_property(PlyReader& reader, const PlyProperty& property) {
    const double count = property.is_list ? reader.read(property.count_type) : 1.0;
    for (double i = 0; i < count; ++i) {
        reader.read(property.type);
    }
}

// The slot of a property, in the order x y z nx ny nz u v r g b; −1 if it is skipped.
int vertex_slot(std::string_view name) {
    constexpr std::pair<std::string_view, int> kSlots[] = {
        {"x", 0}, {"y", 1}, {"z", 2},  {"nx", 3},  {"ny", 4},        {"nz", 5},
        {"u", 6}, {"v", 7}, {"s", 6},  {"t", 7},   {"texture_u", 6}, {"texture_v", 7},
        {"r", 8}, {"g", 9}, {"b", 10}, {"red", 8}, {"green", 9},     {"blue", 10}};
    for (const auto& [known, slot] : kSlots) {
        if (known == name) {
            return slot;
        }
    }
    return -1;
}

void read_vertices(PlyReader& reader, const PlyElement& element, Mesh& mesh) {
    std::vector<int> slots;
    std::array<bool, 11> present{};
    for (const PlyProperty& property : element.properties) {
        slots.push_back(property.is_list ? -1 : vertex_slot(property.name));
        if (slots.back() >= 0) {
            present[static_cast<std::size_t>(slots.back())] = true;
        }
    }
    if (!present[0] || !present[1] || !present[2]) {
        fail(mesh.source, "PLY vertices need x, y and z");
    }
    const bool has_normals = present[3] && present[4] && present[5];
    const bool has_uvs = present[6] && present[7];
    const bool has_colors = present[8] && present[9] && present[10];
    mesh.positions.reserve(element.count);
    mesh.normals.reserve(has_normals ? element.count : 0);
    mesh.uvs.reserve(has_uvs ? element.count : 0);
    mesh.colors.reserve(has_colors ? element.count : 0);
    for (std::size_t i = 0; i < element.count; ++i) {
        std::array<float, 11> values{};
        for (std::size_t p = 0; p < slots.size(); ++p) {
            if (slots[p] < 0) {
                skip_property(reader, element.properties[p]);
            } else {
                values[static_cast<std::size_t>(slots[p])] =
                    static_cast<float>(reader.read(element.properties[p].type));
            }
        }
        mesh.positions.push_back({values[0], values[1], values[2]});
        if (has_normals) {
            mesh.normals.push_back({values[3], values[4], values[5]});
        }
        if (has_uvs) {
            mesh.uvs.push_back({values[6], values[7]});
        }
        if (has_colors) {
            mesh.colors.push_back({values[8], values[9], values[10]});
        }
    }
}

uint read_index(PlyReader& reader, Scalar type, const Mesh& mesh) {
    const double index = reader.read(type);
    if (!(index >= 0.0 && index < static_cast<double>(mesh.positions.size()))) {
        fail(mesh.source, "PLY face refers to vertex " + std::to_string(static_cast<long long>(index)) +
                              ", but there are only " + std::to_string(mesh.positions.size()));
    }
    return static_cast<uint>(index);
}

void read_faces(PlyReader& reader, const PlyElement& element, Mesh& mesh) {
    mesh.triangles.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
            if (!property.is_list || (property.name != "vertex_indices" && property.name != "vertex_index")) {
                skip_property(reader, property);
                continue;
            }
            const double count = reader.read(property.count_type);
            std::array<uint, 3> fan{};
            for (int corner = 0; corner < count; ++corner) {
                const uint index = read_index(reader, property.type, mesh);
                if (corner < 2) {
                    fan[static_cast<std::size_t>(corner)] = index;
                    continue;
                }
                fan[2] = index;
                mesh.triangles.push_back(fan);
                fan[1] = index;
            }
        }
    }
}

}  // namespace

Mesh read_ply(const std::filesystem::path& file) {
    const std::string text = read_file_text(file);
    const PlyHeader header = parse_header(file, text);
    PlyReader reader(file, std::string_view(text).substr(header.size), header.format);
    Mesh mesh;
    mesh.source = file;
    for (const PlyElement& element : header.elements) {
        // Each element takes at least one byte, so a count beyond the file's size is a broken header.
        if (!element.properties.empty() && element.count > reader.bytes_left()) {
            fail(file, "PLY file is truncated");
        }
        if (element.name == "vertex") {
            read_vertices(reader, element, mesh);
        } else if (element.name == "face") {
            read_faces(reader, element, mesh);
        } else {
            for (std::size_t i = 0; i < element.count; ++i) {
                for (const PlyProperty& property : element.properties) {
                    skip_property(reader, property);
                }
            }
        }
    }
    return mesh;
}

}  // namespace nearlight::core
