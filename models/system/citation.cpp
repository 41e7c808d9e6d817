#include "system/citation.hpp"

#include <array>
#include <utility>

namespace monograin {
namespace {

using std::string;
using std::string_view;

/// Replaces every occurrence of a part of the text.
string replaced(string text, string_view part, string_view by) {
  for (std::size_t at = text.find(part); at != string::npos; at = text.find(part, at + by.size())) {
    text.replace(at, part.size(), by);
  }
  return text;
}

/// Joins the authors for reading: "A and B and C" becomes "A, B and C".
string listed_authors(string_view authors) {
  constexpr string_view k_and = " and ";
  const std::size_t last = authors.rfind(k_and);
  if (last == string_view::npos) return string(authors);
  return replaced(string(authors.substr(0, last)), k_and, ", ").append(authors.substr(last));
}

/// Letters of the entries outside ASCII, with their TeX commands.
constexpr auto k_tex_letters = std::to_array<std::pair<string_view, string_view>>(
    {{"Å", "{\\AA}"}, {"å", "{\\aa}"}, {"ö", "{\\\"o}"}, {"ü", "{\\\"u}"}, {"—", "---"}});

string in_tex(string_view text) {
  string result(text);
  for (const auto& [letter, tex] : k_tex_letters) result = replaced(std::move(result), letter, tex);
  return result;
}

string_view entry_type(Citation::Kind kind) {
  switch (kind) {
    case Citation::Kind::article:
      return "article";
    case Citation::Kind::thesis:
      return "mastersthesis";
    case Citation::Kind::manuscript:
      return "misc";
  }
  return {};
}

}  // namespace

string citation_text(const Citation& c) {
  string text = listed_authors(c.authors);
  text.append(" (").append(c.year.empty() ? "n.d." : c.year).append("), ").append(c.title);
  if (c.kind == Citation::Kind::thesis) text += ", M.Sc. thesis";
  if (!c.venue.empty()) text.append(", ").append(c.venue);
  if (!c.volume.empty()) text.append(" ").append(c.volume);
  if (!c.pages.empty()) text.append(", ").append(c.pages);
  if (!c.doi.empty()) text.append(", doi:").append(c.doi);
  return text;
}

string bibtex(const Citation& c) {
  string text = "@" + string(entry_type(c.kind)) + "{" + string(c.key);
  const auto add = [&text](string_view name, const string& value) {
    if (!value.empty()) text.append(",\n  ").append(name).append(" = {").append(value).append("}");
  };
  add("author", in_tex(c.authors));
  add("title", "{" + in_tex(c.title) + "}");  // inner braces keep a style from changing capitals
  add(c.kind == Citation::Kind::thesis ? "school" : "journal", in_tex(c.venue));
  const std::size_t bracket = c.volume.find('(');
  const string_view volume = c.volume.substr(0, bracket);
  add("volume", string(volume.substr(0, volume.find_last_not_of(' ') + 1)));
  if (bracket != string_view::npos) {
    add("number", string(c.volume.substr(bracket + 1, c.volume.size() - bracket - 2)));
  }
  add("pages", replaced(string(c.pages), "-", "--"));
  add("year", string(c.year));
  add("doi", string(c.doi));
  if (c.year.empty()) add("note", "n.d.");
  return text + "\n}\n";
}

namespace references {

const Citation k_agarwal2018{
    .key = "agarwal2018",
    .authors = "A. Agarwal and M. Gonzalez",
    .title =
        "Contact radius and curvature corrections to the nonlocal contact formulation accounting for "
        "multi-particle interactions in elastic confined granular systems",
    .venue = "International Journal of Engineering Science",
    .volume = "133",
    .pages = "26-46",
    .year = "2018",
    .doi = "10.1016/j.ijengsci.2018.08.006"};

const Citation k_biwa1995{.key = "biwa1995",
                          .authors = "S. Biwa and B. Storåkers",
                          .title = "An analysis of fully plastic Brinell indentation",
                          .venue = "Journal of the Mechanics and Physics of Solids",
                          .volume = "43(8)",
                          .pages = "1303-1333",
                          .year = "1995",
                          .doi = "10.1016/0022-5096(95)00031-D"};

const Citation k_edmans{.key = "edmans",
                        .authors = "B. D. Edmans and I. C. Sinka",
                        .title = "Numerical derivation of a normal contact law for compressible plastic particles",
                        .kind = Citation::Kind::manuscript};

const Citation k_hertz1882{.key = "hertz1882",
                           .authors = "H. Hertz",
                           .title = "Ueber die Berührung fester elastischer Körper",
                           .venue = "Journal für die reine und angewandte Mathematik",
                           .volume = "92",
                           .pages = "156-171",
                           .year = "1882",
                           .doi = "10.1515/crll.1882.92.156"};

const Citation k_monograin{.key = "monograin",
                           .authors = "The monograin developers",
                           .title = "monograin, a workbench for the mechanics of a single particle under contact",
                           .year = "2026",
                           .kind = Citation::Kind::manuscript};

const Citation k_nezamabadi2022{.key = "nezamabadi2022",
                                .authors = "S. Nezamabadi and M. Ghadiri and J.-Y. Delenne and F. Radjai",
                                .title = "Modelling the compaction of plastic particle packings",
                                .venue = "Computational Particle Mechanics",
                                .volume = "9(1)",
                                .pages = "45-52",
                                .year = "2022",
                                .doi = "10.1007/s40571-021-00391-4"};

const Citation k_shahin2021{.key = "shahin2021",
                            .authors = "M. B. Shahin",
                            .title =
                                "Contact laws for large deformation unconfined and confined compression of "
                                "spherical plastic particles with power-law hardening",
                            .venue = "Purdue University",
                            .year = "2021",
                            .kind = Citation::Kind::thesis};

const Citation k_storakers1997{.key = "storakers1997",
                               .authors = "B. Storåkers and S. Biwa and P.-L. Larsson",
                               .title = "Similarity analysis of inelastic contact",
                               .venue = "International Journal of Solids and Structures",
                               .volume = "34(24)",
                               .pages = "3061-3083",
                               .year = "1997",
                               .doi = "10.1016/S0020-7683(96)00176-X"};

const Citation k_zunker2024{.key = "zunker2024",
                            .authors = "W. Zunker and K. Kamrin",
                            .title =
                                "A mechanically-derived contact model for adhesive elastic-perfectly plastic "
                                "particles. Part I: Utilizing the method of dimensionality reduction",
                            .venue = "Journal of the Mechanics and Physics of Solids",
                            .volume = "183",
                            .pages = "105492",
                            .year = "2024",
                            .doi = "10.1016/j.jmps.2023.105492"};

const Citation k_zunker2024b{.key = "zunker2024b",
                             .authors = "W. Zunker and K. Kamrin",
                             .title =
                                 "A mechanically-derived contact model for adhesive elastic-perfectly plastic "
                                 "particles. Part II: Contact under high compaction—modeling a bulk elastic response",
                             .venue = "Journal of the Mechanics and Physics of Solids",
                             .volume = "183",
                             .pages = "105493",
                             .year = "2024",
                             .doi = "10.1016/j.jmps.2023.105493"};

}  // namespace references
}  // namespace monograin
