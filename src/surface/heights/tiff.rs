//! Gray TIFF pictures as heights, with the "no data" value of GDAL.

use ::tiff::decoder::{Decoder, DecodingResult};
use ::tiff::tags::Tag;
use ::tiff::{ColorType, TiffError, TiffUnsupportedError};

use super::raster::{NoData, Raster};
use super::{HeightError, size};

/// The TIFF tag in which GDAL writes, as text, the value that means "no data".
const GDAL_NODATA: u16 = 42113;

pub(super) fn read(bytes: &[u8], nodata: Option<f64>) -> Result<Raster, HeightError> {
    let mut decoder = Decoder::new(std::io::Cursor::new(bytes))?;
    let (columns, rows) = decoder.dimensions()?;
    let (columns, rows) = (columns as usize, rows as usize);
    size(columns, rows)?;
    if !matches!(decoder.colortype()?, ColorType::Gray(_)) {
        return Err(HeightError::Colors);
    }
    let named = decoder.find_tag(Tag::Unknown(GDAL_NODATA))?;
    let named = named.and_then(|value| value.into_string().ok());
    let named = named.and_then(|text| fast_float2::parse(text.trim_matches([' ', '\0'])).ok());
    let nodata = NoData::new(nodata, named);
    fn heights<T: Copy + Into<f64>>(values: &[T], white: f64, nodata: NoData) -> Vec<f64> {
        values.iter().map(|&z| nodata.height(z.into()) / white).collect()
    }
    let heights = match decoder.read_image()? {
        DecodingResult::U8(z) => heights(&z, f64::from(u8::MAX), nodata),
        DecodingResult::U16(z) => heights(&z, f64::from(u16::MAX), nodata),
        DecodingResult::U32(z) => heights(&z, f64::from(u32::MAX), nodata),
        DecodingResult::I8(z) => heights(&z, 1.0, nodata),
        DecodingResult::I16(z) => heights(&z, 1.0, nodata),
        DecodingResult::I32(z) => heights(&z, 1.0, nodata),
        DecodingResult::F32(z) => heights(&z, 1.0, nodata.in_single_precision()),
        DecodingResult::F64(z) => heights(&z, 1.0, nodata),
        _ => {
            let kind = TiffUnsupportedError::UnknownInterpretation;
            return Err(TiffError::UnsupportedError(kind).into());
        }
    };
    let mut raster = Raster::new(columns, rows, heights);
    raster.flip();
    Ok(raster)
}
