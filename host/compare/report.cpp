// SPDX-License-Identifier: Apache-2.0
#include "host/compare/report.h"

#include "host/base/files.h"
#include "host/compare/report_csv.h"
#include "host/compare/report_html.h"
#include "host/compare/report_json.h"
#include "host/compare/report_markdown.h"

namespace nearlight::core {

std::string write_report(const Comparison& comparison, const CompareSettings& settings) {
    std::string json = comparison_json(comparison, settings);
    write_text(settings.output / "compare.json", json + "\n");
    write_text(settings.output / "equal_vpls.csv", equal_vpls_csv(comparison));
    write_text(settings.output / "equal_rmse.csv", equal_rmse_csv(comparison, settings));
    write_text(settings.output / "report.html", comparison_html(comparison, settings));
    write_text(settings.output / "report.md", comparison_markdown(comparison, settings));
    return json;
}

}  // namespace nearlight::core
