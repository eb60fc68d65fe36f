#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/exemplar/uv_map.h"
#include "core/image/image.h"

/// Images for pages: shrunk and encoded as data URIs.
namespace terrazzo {

/// The relative frequencies of values from 0 to 1, where a pixel's value is the mean of its colour channels.
using Histogram = std::array<float, 64>;

/// An image file in memory.
struct PictureFile {
  std::string type;  ///< "image/png"
  std::vector<uint8_t> bytes;
};

/// An image as people see it: colours in sRGB, values outside [0, 1] clipped, height maps that exceed it rescaled. At
/// most `longest` pixels a side. Pulls every pixel once.
ImagePtr shrunk_for_display(const ImagePtr& image, int longest);

/// What shrunk_for_display returned as a file: JPEG for large colours, else PNG. `exact`: PNG in any case.
PictureFile picture_file(const Image& display, bool exact = false);

/// An image prepared for a page. Colours are shown in sRGB. Values outside [0, 1] are clipped, but height maps that
/// exceed it are rescaled. Two channels are shown as red and green.
struct PagePicture {
  std::string uri;    ///< JPEG for large colours, else PNG
  std::string small;  ///< the same at about 64 pixels
  Size size;          ///< of the image itself
  ImagePtr shrunk;    ///< the image in `uri`
  Histogram histogram{};
};

/// Shrinks the image to at most `longest` pixels a side. Pulls every pixel once.
PagePicture page_picture(const ImagePtr& image, int longest);

/// A uv map in colours: red is the x position in the exemplar, green the y position. At most `longest` pixels a side.
/// Pixels are sampled, since positions cannot be averaged.
ImagePtr uv_in_colours(const UvMap& uv, int longest);

/// The side at which a page of `count` square pictures still loads quickly, at most `longest`.
int side_for(size_t count, int longest);

/// The pictures of a page. Each image is embedded once, however often it is shown.
class PagePictures {
 public:
  /// Adds an image and returns its element's id: "picture-3". Later calls for the same image ignore `longest`.
  std::string add(const ImagePtr& image, int longest);
  const PagePicture& operator[](const std::string& id) const { return pictures_.at(id).picture; }

  /// Whether `figure` has been called for it.
  bool is_shown(const std::string& id) const { return pictures_.at(id).on_page; }
  /// The picture as HTML with a caption; a click shows it at full size. If it is already on the page, a copy that the
  /// page's script fills.
  std::string figure(const std::string& id, const std::string& caption);

 private:
  struct Shown {
    PagePicture picture;
    bool on_page = false;
  };
  std::map<std::string, Shown> pictures_;
  std::map<std::pair<std::string, Semantic>, std::string> ids_;  ///< by digest and semantic
};

}  // namespace terrazzo
