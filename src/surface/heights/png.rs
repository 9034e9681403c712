//! Gray PNG pictures as heights.

use super::raster::{NoData, Raster};
use super::{HeightError, size};

pub(super) fn read(bytes: &[u8], nodata: Option<f64>) -> Result<Raster, HeightError> {
    let mut decoder = ::png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(::png::Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let info = reader.info();
    let (columns, rows) = (info.width as usize, info.height as usize);
    let count = size(columns, rows)?;
    let channels = match reader.output_color_type().0 {
        ::png::ColorType::Grayscale => 1,
        ::png::ColorType::GrayscaleAlpha => 2,
        _ => return Err(HeightError::Colors),
    };
    let is_wide = reader.output_color_type().1 == ::png::BitDepth::Sixteen;
    let n_bytes = count * channels * if is_wide { 2 } else { 1 };
    let mut pixels = vec![0; reader.output_buffer_size().unwrap_or(n_bytes).max(n_bytes)];
    reader.next_frame(&mut pixels)?;
    let nodata = NoData::new(nodata, None);
    let heights = if is_wide {
        let gray = |p: &[u8]| f64::from(u16::from_be_bytes([p[0], p[1]]));
        let pixels = pixels[..n_bytes].chunks_exact(2 * channels);
        pixels.map(|p| nodata.height(gray(p)) / f64::from(u16::MAX)).collect()
    } else {
        let pixels = pixels[..n_bytes].chunks_exact(channels);
        pixels.map(|p| nodata.height(f64::from(p[0])) / f64::from(u8::MAX)).collect()
    };
    let mut raster = Raster::new(columns, rows, heights);
    raster.flip();
    Ok(raster)
}
