// SPDX-License-Identifier: Apache-2.0
#include "host/compare/cell_store.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/image/image_io.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

using Json = nlohmann::ordered_json;

/// Change this when the meaning of a cell's contents changes.
constexpr const char* kCellFormat = "cell 1";

/// Reads a number; NaN and infinity, which JSON cannot represent, are stored as null.
double number(const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// Reads a whole number of 0 or more. Others count as broken, like what is no number.
std::size_t count_in(const Json& value) {
    return value.get_ref<const Json::number_unsigned_t&>();
}

Json to_json(const Cell& cell) {
    return {{"method", to_string(cell.id.method)},
            {"vpls", cell.id.vpls},
            {"seed", cell.id.seed},
            {"close_vpls", cell.close_vpls},
            {"distant_vpls", cell.distant_vpls},
            {"sparse_vpls", cell.sparse_vpls},
            {"squared_error", cell.error.squared_error},
            {"relative_mse", cell.error.relative_mse},
            {"mean_ratio", cell.error.mean_ratio},
            {"mean_error", cell.error.mean_error},
            {"flip", cell.error.flip},
            {"non_finite", cell.error.non_finite},
            {"generate_s", cell.generate_seconds},
            {"gather_s", cell.gather_seconds},
            {"image_hash", cell.image_hash}};
}

Cell from_json(const Json& json, const CellId& id) {
    Cell cell{.id = id,
              .close_vpls = count_in(json.at("close_vpls")),
              .distant_vpls = count_in(json.at("distant_vpls")),
              .sparse_vpls = count_in(json.at("sparse_vpls")),
              .error = {},
              .generate_seconds = number(json.at("generate_s")),
              .gather_seconds = number(json.at("gather_s")),
              .image_hash = json.at("image_hash")};
    cell.error.squared_error = number(json.at("squared_error"));
    cell.error.relative_mse = number(json.at("relative_mse"));
    cell.error.mean_ratio = number(json.at("mean_ratio"));
    for (std::size_t c = 0; c < 3; ++c) {
        cell.error.mean_error[c] = number(json.at("mean_error").at(c));
    }
    cell.error.flip = number(json.at("flip"));
    cell.error.non_finite = count_in(json.at("non_finite"));
    return cell;
}

}  // namespace

std::filesystem::path CellStore::file_stem_of(const CellId& id) const {
    const std::string name =
        file_stem(id.method) + "-" + std::to_string(id.vpls) + "-seed" + std::to_string(id.seed);
    return folder_ /
           (name + "-" + hex_digits(hash64(std::string(kCellFormat) + "|" + conditions_ + "|" + name)));
}

std::optional<Cell> CellStore::load(const CellId& id) const {
    const std::filesystem::path file = file_stem_of(id).string() + ".json";
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        return std::nullopt;
    }
    try {
        return from_json(Json::parse(read_bytes(file)), id);
    } catch (const Json::exception&) {
        say_warning("'" + file.string() + "' is broken; measuring that cell again");
    } catch (const Error& error) {
        say_warning(std::string(error.what()) + "; measuring that cell again");
    }
    return std::nullopt;
}

void CellStore::save(const Cell& cell) const {
    make_folder(folder_);
    write_text(file_stem_of(cell.id).string() + ".json", to_json(cell).dump(2) + "\n");
}

void CellStore::save_picture(const CellId& id, const Image& picture) const {
    make_folder(folder_);
    write_image(file_stem_of(id).string() + ".exr", picture);
}

bool CellStore::has_picture(const CellId& id) const {
    std::error_code ignored;
    return std::filesystem::exists(file_stem_of(id).string() + ".exr", ignored);
}

Image CellStore::load_picture(const CellId& id) const {
    return read_image(file_stem_of(id).string() + ".exr");
}

}  // namespace nearlight::core
