// Handles clicks and moves of the pointer over the ground: drawing, selecting and dragging.
import Modify from 'ol/interaction/Modify';
import Translate from 'ol/interaction/Translate';
import type OlMap from 'ol/Map';
import type Feature from 'ol/Feature';
import type Polygon from 'ol/geom/Polygon';
import type { Drawing } from './drawing';
import { boxOf, moved, movedCorners } from './geometry';
import type { GroundMap } from './ground_map';
import { byId } from '../panels/messages';
import type { Store } from '../store';
import type { Point } from '../types';
import type { Work } from '../work';

const kDragPx = 2; // a click moves the pointer by less
const kTwicePx = 8;

export function listenToPointer(ground: GroundMap, drawing: Drawing, store: Store, work: Work): void {
  const { map } = ground;
  map.on('pointermove', (event) => {
    if (drawing.active) drawing.move(event.coordinate as Point);
    else byId('map').classList.toggle('over', ground.at(event.pixel) !== null);
  });
  map.on('click', (event) => {
    if (drawing.active) return drawing.add(event.coordinate as Point);
    work.flush();
    const hit = ground.at(event.pixel);
    if (hit) store.select(hit);
    else work.deselect();
  });
  // OpenLayers reports a double click for any two quick clicks, wherever they are.
  map.on('dblclick', () => {
    const reach = kTwicePx * pixel(map);
    if (drawing.active && drawing.isDoubleClick(reach)) drawing.finishPolygon(reach);
  });
  const idle = (): boolean => !drawing.active;
  map.addInteraction(draggedWhole(ground, idle, store, work));
  map.addInteraction(draggedCorners(ground, idle, store, work));
}

function draggedWhole(ground: GroundMap, condition: () => boolean, store: Store, work: Work): Translate {
  const translate = new Translate({ layers: [ground.markedLayer], condition });
  translate.on('translateend', ({ coordinate, startCoordinate }) => {
    const [dx, dy] = [coordinate[0] - startCoordinate[0], coordinate[1] - startCoordinate[1]];
    if (Math.hypot(dx, dy) < kDragPx * pixel(ground.map)) return store.notify('selection'); // a click
    const label = store.selectedLabel();
    const box = store.selectedHypothesis() ?? (label && boxOf(label));
    if (box) work.reshape(moved(box, dx, dy));
    else if (label) work.reshape(movedCorners(label.corners, dx, dy));
  });
  return translate;
}

// Only for polygons. Otherwise it marks a corner of every box under the pointer.
function draggedCorners(ground: GroundMap, condition: () => boolean, store: Store, work: Work): Modify {
  const modify = new Modify({ source: ground.marked, condition });
  const cornersOf = (feature: Feature): Point[] =>
    (feature.getGeometry() as Polygon).getCoordinates()[0].slice(0, -1) as Point[];
  modify.on('modifyend', (event) => work.reshape(cornersOf(event.features.item(0) as Feature)));
  const onlyPolygons = (): void => modify.setActive(store.selectedLabel()?.shape === 'polygon');
  store.on('selection', onlyPolygons);
  onlyPolygons();
  return modify;
}

const pixel = (map: OlMap): number => map.getView().getResolution()!;
