// The page of the report, without its data: report/report.html as CMake reads it.
#pragma once

namespace donex {

extern const char* const kReportPage;

}  // namespace donex
