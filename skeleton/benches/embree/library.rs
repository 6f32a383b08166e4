//! The functions of the Embree 4 C API for single rays, loaded from a library at run time: see
//! the manual pages of `rtcNewScene`, `rtcIntersect1`, `rtcOccluded1`.

use std::ffi::{c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr::null;

use arty::math::Vec3;
use libloading::{Library, Symbol};

/// Constants of Embree's headers.
const GEOMETRY_TYPE_TRIANGLE: c_int = 0;
const BUFFER_TYPE_INDEX: c_int = 0;
const BUFFER_TYPE_VERTEX: c_int = 1;
const FORMAT_UINT3: c_int = 0x5003;
const FORMAT_FLOAT3: c_int = 0x9003;
const SCENE_FLAG_ROBUST: c_int = 1 << 2;
const PROPERTY_VERSION_MAJOR: c_int = 1;
const INVALID: c_uint = c_uint::MAX;

type Handle = *mut c_void;

/// `RTCRayHit`, with space for more instance levels than any build has.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    barycentrics: [f32; 2],
    primitive: c_uint,
    geometry: c_uint,
    instances: [c_uint; 17],
}

impl RayHit {
    fn new(origin: Vec3, direction: Vec3, t_far: f32) -> Self {
        Self {
            origin: origin.to_array(),
            t_near: 0.0,
            direction: direction.to_array(),
            time: 0.0,
            t_far,
            mask: c_uint::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            barycentrics: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instances: [INVALID; 17],
        }
    }
}

/// The loaded library. It is never unloaded: its threads may still be running when this program ends.
pub(super) struct Embree {
    library: &'static Library,
    device: Handle,
}

/// A committed scene of one mesh.
pub(super) struct EmbreeScene<'a> {
    scene: Handle,
    intersect: Symbol<'a, unsafe extern "C" fn(Handle, *mut RayHit, *const c_void)>,
    occluded: Symbol<'a, unsafe extern "C" fn(Handle, *mut RayHit, *const c_void)>,
}

impl Embree {
    /// Loads a library and creates a device.
    pub(super) fn load(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        // SAFETY: the user who names a library trusts its initialization code; that of Embree has no requirements.
        let library: &'static Library = Box::leak(Box::new(unsafe { Library::new(path) }?));
        // SAFETY: the signature of `rtcNewDevice`; without a configuration it uses the defaults.
        let device = unsafe {
            library.get::<unsafe extern "C" fn(*const c_char) -> Handle>(b"rtcNewDevice\0")?(null())
        };
        if device.is_null() {
            return Err("Embree finds no device".into());
        }
        type Property = unsafe extern "C" fn(Handle, c_int) -> isize;
        // SAFETY: the signature of `rtcGetDeviceProperty`; the device is valid.
        let version =
            unsafe { library.get::<Property>(b"rtcGetDeviceProperty\0")?(device, PROPERTY_VERSION_MAJOR) };
        if version != 4 {
            return Err(format!("Embree 4 is needed, this is version {version}").into());
        }
        Ok(Self { library, device })
    }

    /// Builds a scene of these triangles, with Embree's watertight triangle test if `robust`.
    pub(super) fn scene(
        &self,
        triangles: &[[Vec3; 3]],
        robust: bool,
    ) -> Result<EmbreeScene<'_>, Box<dyn std::error::Error>> {
        type New = unsafe extern "C" fn(Handle) -> Handle;
        type Act = unsafe extern "C" fn(Handle);
        type Buffer = unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
        let corners = triangles.as_flattened();
        // SAFETY: names and signatures are those of Embree 4's headers; handles are passed unchanged; the buffers
        // it allocates are large enough for the data, including the required padding.
        unsafe {
            let scene = self.library.get::<New>(b"rtcNewScene\0")?(self.device);
            if robust {
                self.library.get::<unsafe extern "C" fn(Handle, c_int)>(b"rtcSetSceneFlags\0")?(
                    scene,
                    SCENE_FLAG_ROBUST,
                );
            }
            let new_geometry =
                self.library.get::<unsafe extern "C" fn(Handle, c_int) -> Handle>(b"rtcNewGeometry\0")?;
            let geometry = new_geometry(self.device, GEOMETRY_TYPE_TRIANGLE);
            let buffer = self.library.get::<Buffer>(b"rtcSetNewGeometryBuffer\0")?;
            let vertices = buffer(geometry, BUFFER_TYPE_VERTEX, 0, FORMAT_FLOAT3, 12, corners.len());
            let indices = buffer(geometry, BUFFER_TYPE_INDEX, 0, FORMAT_UINT3, 12, triangles.len());
            if vertices.is_null() || indices.is_null() {
                return Err("Embree has no memory for the mesh".into());
            }
            std::slice::from_raw_parts_mut(vertices.cast::<[f32; 3]>(), corners.len())
                .iter_mut()
                .zip(corners)
                .for_each(|(to, from)| *to = from.to_array());
            std::slice::from_raw_parts_mut(indices.cast::<u32>(), corners.len())
                .iter_mut()
                .zip(0..)
                .for_each(|(to, index)| *to = index);
            self.library.get::<Act>(b"rtcCommitGeometry\0")?(geometry);
            self.library.get::<unsafe extern "C" fn(Handle, Handle) -> c_uint>(b"rtcAttachGeometry\0")?(
                scene, geometry,
            );
            self.library.get::<Act>(b"rtcReleaseGeometry\0")?(geometry);
            self.library.get::<Act>(b"rtcCommitScene\0")?(scene);
            Ok(EmbreeScene {
                scene,
                intersect: self.library.get(b"rtcIntersect1\0")?,
                occluded: self.library.get(b"rtcOccluded1\0")?,
            })
        }
    }
}

impl EmbreeScene<'_> {
    /// The first triangle hit by the ray.
    #[inline]
    pub(super) fn intersect(&self, origin: Vec3, direction: Vec3) -> Option<u32> {
        let mut ray = RayHit::new(origin, direction, f32::INFINITY);
        // SAFETY: the scene is committed and the ray initialized and aligned to 16 bytes, as the manual page requires;
        // without arguments Embree uses its defaults.
        unsafe { (self.intersect)(self.scene, &mut ray, null()) };
        (ray.geometry != INVALID).then_some(ray.primitive)
    }

    /// True if a triangle is between the points, up to the last 1e-4 of the distance, where the triangle of the target is.
    #[inline]
    pub(super) fn occluded(&self, origin: Vec3, target: Vec3) -> bool {
        let mut ray = RayHit::new(origin, target - origin, 1.0 - 1e-4);
        // SAFETY: as above; the first 48 bytes of a `RayHit` are an `RTCRay`.
        unsafe { (self.occluded)(self.scene, &mut ray, null()) };
        ray.t_far < 0.0
    }
}
