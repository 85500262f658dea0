//! From SVG to pixels.

use std::fmt;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Pixels of the file for one of the picture: letters stay sharp on dense screens.
const DENSITY: f32 = 2.0;

/// The only letters we bring; what the machine has would make other pictures elsewhere.
const FAMILY: &str = "DejaVu Sans";

/// Why an SVG cannot be made pixels.
#[derive(Debug)]
pub struct Unpaintable(String);

impl fmt::Display for Unpaintable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the picture cannot be made a PNG ({}); as SVG it can be written", self.0)
    }
}

impl std::error::Error for Unpaintable {}

/// An SVG as the bytes of a PNG, two pixels for each of its own; the same on every machine.
///
/// # Errors
/// When the text is no SVG or its size is none that a picture can have.
pub fn png(svg: &str) -> Result<Vec<u8>, Unpaintable> {
    let unpaintable = |reason: &dyn fmt::Display| Unpaintable(reason.to_string());
    let tree = Tree::from_str(svg, &options()).map_err(|error| unpaintable(&error))?;
    let size = tree.size().to_int_size().scale_by(DENSITY).ok_or_else(|| unpaintable(&"it has no size"))?;
    let mut pixels =
        Pixmap::new(size.width(), size.height()).ok_or_else(|| unpaintable(&"it is too large"))?;
    resvg::render(&tree, Transform::from_scale(DENSITY, DENSITY), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| unpaintable(&error))
}

fn options() -> Options<'static> {
    let mut fonts = fontdb::Database::new();
    for font in [dejavu::sans::regular(), dejavu::sans::bold()] {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FAMILY);
    // What is taken where a picture names none that is here.
    fonts.set_serif_family(FAMILY);
    Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_lines_are_painted_twice_as_large() {
        let svg = |inside: &str| {
            format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20">{inside}</svg>"#)
        };
        let painted = png(&svg(r#"<text x="5" y="15" font-family="Arial">12 s</text>"#)).unwrap();
        let pixels = Pixmap::decode_png(&painted).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (120, 40));
        assert!(pixels.pixels().iter().any(|pixel| pixel.alpha() > 200), "there are letters");
        let empty = Pixmap::decode_png(&png(&svg("")).unwrap()).unwrap();
        assert!(empty.pixels().iter().all(|pixel| pixel.alpha() == 0));
    }

    #[test]
    fn what_is_no_picture_says_so() {
        let message = png("<p>hello</p>").unwrap_err().to_string();
        assert!(message.starts_with("the picture cannot be made a PNG"), "{message}");
        assert!(png("").is_err());
    }
}
