// SPDX-License-Identifier: Apache-2.0
// The structure of Stanford PLY files: a header that describes tables, and their numbers, in ASCII or in
// binary of either byte order.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core {

enum class PlyScalar { i8, u8, i16, u16, i32, u32, i64, u64, f16, f32, f64 };
enum class PlyFormat { ascii, little, big };

/// The largest number of a type of whole numbers; 0 for the others.
double largest_number(PlyScalar type);

/// A column of a table.
struct PlyProperty {
    std::string name;
    PlyScalar type = PlyScalar::f32;
    bool is_list = false;
    PlyScalar count_type = PlyScalar::u8;  ///< of a list's length
};

/// A table.
struct PlyElement {
    std::string name;
    std::size_t count = 0;  ///< rows
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<std::string> comments;  ///< without the keyword
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes
};

/// Throws Error(ErrorKind::file), which names the file, and the setting to change if there is one.
[[noreturn]] void fail_ply(const std::filesystem::path& file, const std::string& what,
                           std::string_view setting = {});

/// Reads the header at the beginning of the text of a file. Throws Error(ErrorKind::file).
PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view text);

/// Reads one number after the other, whatever the format. It keeps references to the file's name and text,
/// and throws Error(ErrorKind::file) where a number should be and is not. In ASCII, comments
/// between rows are passed over. A row that is not one line counts as long as the file has as many
/// numbers as its header promises.
class PlyReader {
  public:
    PlyReader(const std::filesystem::path& file, std::string_view text, const PlyHeader& header)
        : file_(file), text_(text), data_(text.substr(header.size)), format_(header.format) {}

    double read(PlyScalar type);
    /// Called behind each row.
    void end_row();
    /// Throws Error(ErrorKind::file) if there is more behind the last row, and rows were not lines, because
    /// the numbers before are then not those that they were taken for.
    void check_end();
    /// Throws Error(ErrorKind::file), which says so if a row before was not one line.
    [[noreturn]] void fail(const std::string& what) const;
    /// Passes over a number or a list.
    void skip(const PlyProperty& property);
    /// Throws Error(ErrorKind::file) if the rest of the file is too short for a table, so that nobody takes
    /// memory for what a broken header promises.
    void check_size_of(const PlyElement& element) const;

  private:
    template <typename T>
    T read_binary();
    void skip_blanks();
    double read_word();

    const std::filesystem::path& file_;
    std::string_view text_;
    std::string_view data_;  ///< what has not been read
    PlyFormat format_;
    bool is_in_row_ = false;
    const char* odd_place_ = nullptr;  ///< on the first line that is not one row
};

}  // namespace nearlight::core
