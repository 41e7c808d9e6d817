/// Published sources of the models: one entry each, shown as a line of text or as BibTeX.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// A publication. Fields that are not known, or do not apply, are empty.
struct Citation {
  enum class Kind { article, thesis, manuscript };
  std::string_view key;      ///< of the BibTeX entry
  std::string_view authors;  ///< initials and family name each, with " and " between them
  std::string_view title;
  std::string_view venue;   ///< journal; of a thesis, the university
  std::string_view volume;  ///< with the issue in brackets
  std::string_view pages;   ///< or the number of the article
  std::string_view year;
  std::string_view doi;
  Kind kind = Kind::article;
};

/// The entry as one line of UTF-8: authors (year), title, venue volume, pages, DOI. A missing year is "n.d.".
[[nodiscard]] std::string citation_text(const Citation& citation);

/// The entry as BibTeX, in ASCII: letters with marks as TeX writes them, and no field that is empty. It ends with a
/// line break.
[[nodiscard]] std::string bibtex(const Citation& citation);

/// Sources of the models.
namespace references {

extern const Citation k_agarwal2018;
extern const Citation k_biwa1995;
extern const Citation k_edmans;
extern const Citation k_hertz1882;
extern const Citation k_monograin;
extern const Citation k_nezamabadi2022;
extern const Citation k_shahin2021;
extern const Citation k_storakers1997;
extern const Citation k_zunker2024;
extern const Citation k_zunker2024b;

}  // namespace references

}  // namespace monograin
