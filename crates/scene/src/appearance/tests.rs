use super::*;
use std::collections::BTreeMap;

fn look(look: Look) -> Appearance {
    Appearance::of(&FileMaterial {
        name: "x".into(),
        properties: BTreeMap::new(),
        look,
    })
}

/// A grey dielectric of glTF: base colour, metallic, roughness, transmission.
fn gltf(base: f64, metallic: f64, roughness: f64, transmission: f64) -> Look {
    Look::Gltf {
        base_color: [base; 3],
        textured: false,
        metallic,
        roughness,
        specular: 1.0,
        specular_color: [1.0; 3],
        ior: None,
        transmission,
        emissive: [0.0; 3],
        alpha: 1.0,
        opaque: true,
        double_sided: true,
        thickness: 0.0,
    }
}

fn mtl(illum: Option<u8>, ni: Option<f64>) -> Look {
    Look::Mtl {
        kd: Some([0.5; 3]),
        ks: Some([0.5; 3]),
        ke: Some([1.0; 3]),
        ni,
        d: None,
        tf: None,
        illum,
        textured: false,
        pr: Some(0.5),
        pm: None,
    }
}

fn near(given: Option<Given>, expected: f64) -> bool {
    given.is_some_and(|(value, _)| (value - expected).abs() < 1e-12)
}

#[test]
fn luminance_weighs_green_most_and_white_is_one() {
    assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-15);
    assert!((luminance([0.0, 1.0, 0.0]) - 0.7152).abs() < 1e-15);
}

#[test]
fn a_dielectric_reflects_its_base_colour_and_shines_by_its_smoothness() {
    let appearance = look(gltf(0.5, 0.0, 0.2, 0.0));
    assert!(near(appearance.rho, 0.5) && near(appearance.a, 0.64));
    assert_eq!((appearance.n, appearance.k), (None, None));
    assert!(appearance.doubts.is_empty());
}

#[test]
fn a_metal_has_its_colour_at_normal_incidence() {
    let appearance = look(gltf(0.57, 1.0, 0.3, 0.0));
    assert!(near(appearance.rho, 0.0) && near(appearance.a, 1.0));
    let (n, k) = (appearance.n.unwrap().0, appearance.k.unwrap().0);
    let reflectance = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
    assert!((reflectance - 0.57).abs() < 1e-12);
    assert!(appearance.doubts[0].to_string().contains("malus_n"));
}

#[test]
fn a_white_metal_is_an_ideal_mirror_and_suspected() {
    let appearance = look(gltf(1.0, 1.0, 0.0, 0.0));
    assert!(appearance.n.unwrap().0.is_infinite());
    assert!(
        appearance.doubts[0]
            .to_string()
            .contains("Diffuse and Glass")
    );
}

#[test]
fn what_is_half_metal_keeps_half_its_diffuse_part() {
    let appearance = look(gltf(0.8, 0.25, 1.0, 0.0));
    assert!(near(appearance.rho, 0.6) && near(appearance.a, 0.25));
    assert_eq!(appearance.k, None);
    assert_eq!(appearance.doubts.len(), 1);
}

#[test]
fn glass_is_a_pane_and_as_a_mixture_reflects_nothing_diffusely() {
    let clear = look(gltf(0.9, 0.0, 0.0, 1.0));
    assert_eq!(clear.pane, Some("KHR_materials_transmission ≥ 0.5"));
    assert!(near(clear.tau, 0.9) && clear.n.is_none());
    assert!(near(clear.rho, 0.0) && near(clear.a, 1.0));
    assert!(matches!(&clear.doubts[..], [Doubt::Opaque(text)] if text.contains("kind = \"pane\"")));
}

#[test]
fn what_transmits_little_shines_or_is_metal_is_no_pane() {
    let is_pane = |it: Look| look(it).pane.is_some();
    assert!(is_pane(gltf(1.0, 0.0, 0.0, 0.5)) && !is_pane(gltf(1.0, 0.0, 0.0, 0.49)));
    assert!(is_pane(gltf(1.0, 0.49, 0.0, 1.0)) && !is_pane(gltf(1.0, 0.5, 0.0, 1.0)));
    let mut glowing = gltf(1.0, 0.0, 0.0, 1.0);
    if let Look::Gltf { emissive, .. } = &mut glowing {
        *emissive = [1.0; 3];
    }
    assert!(!is_pane(glowing));
}

#[test]
fn what_a_pane_cannot_have_of_its_file_is_doubted() {
    let doubts = |roughness, transmission| {
        let doubts = look(gltf(1.0, 0.0, roughness, transmission)).doubts;
        let of_kind = doubts.into_iter().filter_map(|doubt| match doubt {
            Doubt::Value(["kind"], text) => Some(text),
            _ => None,
        });
        of_kind.collect::<Vec<_>>().join(" ")
    };
    assert!(doubts(0.0, 0.75).contains("a share of 0.75"));
    assert!(doubts(0.3, 1.0).contains("is rough (0.3)"));
    assert_eq!(doubts(0.1, 1.0), "");
}

#[test]
fn emission_of_gltf_is_pi_times_its_luminance() {
    let mut glowing = gltf(0.0, 0.0, 0.0, 0.0);
    if let Look::Gltf { emissive, .. } = &mut glowing {
        *emissive = [12.0, 0.0, 0.0];
    }
    assert!(near(look(glowing).exitance, PI * 12.0 * 0.2126));
}

#[test]
fn transparency_counts_only_where_the_alpha_mode_says_so() {
    for (is_opaque, doubts) in [(true, 0), (false, 1)] {
        let mut glass = gltf(0.5, 0.0, 0.5, 0.0);
        if let Look::Gltf { alpha, opaque, .. } = &mut glass {
            (*alpha, *opaque) = (0.3, is_opaque);
        }
        assert_eq!(look(glass).doubts.len(), doubts);
    }
}

#[test]
fn obj_is_mirror_like_from_illumination_model_three_on() {
    assert!(near(look(mtl(Some(2), None)).a, 0.0));
    assert!(near(look(mtl(None, None)).a, 0.0));
    assert!(near(look(mtl(Some(3), None)).a, 0.5 * 0.25));
}

#[test]
fn an_obj_index_of_one_means_that_nothing_is_known() {
    assert_eq!(look(mtl(Some(2), Some(1.0))).n, None);
    assert!(near(look(mtl(Some(2), Some(1.46))).n, 1.46));
    assert!(near(look(mtl(Some(2), None)).rho, 0.5));
    assert!(near(look(mtl(Some(2), None)).exitance, PI));
}

#[test]
fn without_a_diffuse_colour_obj_gives_no_reflectance() {
    let mut bare = mtl(Some(2), None);
    if let Look::Mtl { kd, .. } = &mut bare {
        *kd = None;
    }
    assert_eq!(look(bare).rho, None);
}

#[test]
fn a_colour_beyond_white_is_not_hidden() {
    assert!(look(gltf(1.5, 0.0, 1.0, 0.0)).rho.unwrap().0 > 1.4);
    assert!(look(gltf(1.0 + 1e-7, 0.0, 1.0, 0.0)).rho.unwrap().0 <= 1.0);
}

#[test]
fn glass_of_blender_s_obj_is_told_by_its_transmission_colour() {
    for (roughness, doubts) in [(Some(0.0), 1), (None, 0)] {
        let mut glass = mtl(Some(2), None);
        if let Look::Mtl { tf, pr, .. } = &mut glass {
            (*tf, *pr) = (Some([1.0; 3]), roughness);
        }
        assert_eq!(look(glass).doubts.len(), doubts);
    }
}
