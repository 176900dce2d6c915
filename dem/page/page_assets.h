#pragma once
#include <string_view>

namespace granrad {

/// The files of dem/page/assets, which every page carries inside itself.
std::string_view page_asset_uplot_js();
std::string_view page_asset_uplot_css();
std::string_view page_asset_uplot_license();
std::string_view page_asset_page_js();
std::string_view page_asset_page_css();
std::string_view page_asset_filter_js();

}  // namespace granrad
