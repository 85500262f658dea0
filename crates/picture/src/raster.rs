//! Renders SVG as PNG.

use std::fmt;
use std::sync::Arc;

use png::{BitDepth, ColorType, Encoder, EncodingError};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::MARK;

/// Image pixels per picture pixel: text stays sharp on high-density screens.
const DENSITY: f32 = 2.0;

/// The embedded font. System fonts would make pictures differ between machines.
const FAMILY: &str = "DejaVu Sans";

/// Why PNG rendering failed.
#[derive(Debug)]
pub struct RenderError(String);

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PNG rendering failed ({}); write an SVG instead", self.0)
    }
}

impl std::error::Error for RenderError {}

/// Renders an SVG as PNG with two pixels per unit, identically on every machine.
///
/// # Errors
/// If the text is not a valid SVG or its size is invalid.
pub fn png(svg: &str) -> Result<Vec<u8>, RenderError> {
    let failed = |reason: &dyn fmt::Display| RenderError(reason.to_string());
    let tree = Tree::from_str(svg, &options()).map_err(|error| failed(&error))?;
    let size = tree.size().to_int_size().scale_by(DENSITY).ok_or_else(|| failed(&"it has no size"))?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or_else(|| failed(&"it is too large"))?;
    resvg::render(&tree, Transform::from_scale(DENSITY, DENSITY), &mut pixels.as_mut());
    encode(pixels).map_err(|error| failed(&error))
}

/// A PNG with the mark of our pictures.
fn encode(pixels: Pixmap) -> Result<Vec<u8>, EncodingError> {
    let (width, height) = (pixels.width(), pixels.height());
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.add_text_chunk("Comment".to_owned(), MARK.to_owned())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels.take_demultiplied())?;
    writer.finish()?;
    Ok(bytes)
}

fn options() -> Options<'static> {
    let mut fonts = fontdb::Database::new();
    for font in [dejavu::sans::regular(), dejavu::sans::bold()] {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FAMILY);
    // The fallback for fonts that are not embedded.
    fonts.set_serif_family(FAMILY);
    Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_rendered_at_double_density() {
        let svg = |inside: &str| {
            format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20">{inside}</svg>"#)
        };
        let painted = png(&svg(r#"<text x="5" y="15" font-family="Arial">12 s</text>"#)).unwrap();
        let pixels = Pixmap::decode_png(&painted).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (120, 40));
        assert!(pixels.pixels().iter().any(|pixel| pixel.alpha() > 200), "there is text");
        assert!(painted.windows(MARK.len()).any(|window| window == MARK.as_bytes()));
        let empty = Pixmap::decode_png(&png(&svg("")).unwrap()).unwrap();
        assert!(empty.pixels().iter().all(|pixel| pixel.alpha() == 0));
    }

    #[test]
    fn invalid_svg_is_an_error() {
        let message = png("<p>hello</p>").unwrap_err().to_string();
        assert!(message.starts_with("PNG rendering failed"), "{message}");
        assert!(png("").is_err());
    }
}
