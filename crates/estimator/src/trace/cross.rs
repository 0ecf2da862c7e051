//! Joining a walk from a sensor to walks from the emitters.

use super::Walk;
use crate::bridge::{self, Abutment, Partners};
use crate::medium::Medium;
use crate::path::{Bridge, Path, Vertex};
use crate::random::Purpose;
use malus_optics::angle_of_incidence;

impl<'a> Walk<'a> {
    /// Joins the point where the walk first scatters to walks from the emitters.
    pub(super) fn cross(&self, path: &mut Path<'a>, vertex: &mut Vertex, partners: Partners<'a>) {
        let Some(chance) = bridge::taking_part(self.uniforms, self.depth) else {
            return;
        };
        let Medium {
            surfaces, covers, ..
        } = self.medium;
        let abutment = Abutment {
            position: vertex.position,
            normal: vertex.normal,
            cell: surfaces.cell(vertex.position),
            onward: vertex.diffuse,
            walks: self.techniques.bridged,
        };
        let share = 1.0 / (chance * partners.walks as f64);
        let polarises = covers[vertex.material as usize].polarises_scattering();
        let (first, lit) = (path.bridges.len(), path.lit.len());
        path.lit.resize(lit + partners.width, 0.0);
        vertex.lit = lit..path.lit.len();
        if !polarises && abutment.cell.is_some() && partners.cell == abutment.cell {
            let lit = &mut path.lit[lit..];
            abutment.add_all(&partners, lit);
            for value in lit {
                *value *= share;
            }
            return;
        }
        let mut candidates = std::mem::take(&mut path.candidates);
        candidates.clear();
        let mut add = |landing: usize, weight: f64| {
            let (from, fluxes) = (&partners.landings[landing], partners.fluxes(landing));
            if polarises || from.polarises {
                path.bridges.push(Bridge {
                    from,
                    fluxes,
                    toward: (from.position - vertex.position).normalize(),
                    weight,
                });
            } else {
                for (lit, flux) in path.lit[lit..].iter_mut().zip(fluxes) {
                    *lit += flux * weight;
                }
            }
        };
        for (index, landing) in partners.landings.iter().enumerate() {
            let cover = &covers[landing.material as usize];
            let weight = share
                * abutment.weight(landing, |direction| {
                    let (cos, sin2) = angle_of_incidence(direction, landing.normal);
                    cover.diffuse(cos, sin2)
                });
            if weight <= 0.0 {
                continue;
            }
            let seen = abutment.cell.is_some() && landing.cell == abutment.cell;
            if seen && !polarises && !landing.polarises {
                add(index, weight);
            } else {
                candidates.push(index, weight, landing.most);
            }
        }
        if !candidates.is_empty()
            && let [_, choice, ..] = self.uniforms.at(self.depth, Purpose::Bridge)
            && let Some((landing, weight)) = candidates.choose(choice)
            && surfaces.visible(vertex.position, partners.landings[landing].position)
        {
            add(landing, weight);
        }
        path.candidates = candidates;
        vertex.bridges = first..path.bridges.len();
    }
}
