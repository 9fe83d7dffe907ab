import * as THREE from 'three';
import type { Configuration, Place } from './api';

const WALL = 2.2; // m, drawn height: one looks in from above
const COLD = 0x9aa3ad;
const HOT = 0xd55e00;

/** Rooms, surfaces and walls as they are configured, and how probable each place is just now. */
export class Home extends THREE.Group {
  readonly box: THREE.Box3;
  private readonly floors = new Map<string, THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>>();

  constructor(configuration: Configuration) {
    super();
    const { min, max } = configuration.world.bounds;
    this.box = new THREE.Box3(
      new THREE.Vector3(min[0], min[1], min[2] ?? 0),
      new THREE.Vector3(max[0], max[1], max[2] ?? 1),
    );
    const size = Math.max(max[0] - min[0], max[1] - min[1]);
    const grid = new THREE.GridHelper(2 * Math.ceil(size), 2 * Math.ceil(size), COLD, COLD);
    grid.rotation.x = Math.PI / 2;
    grid.position.set((min[0] + max[0]) / 2, (min[1] + max[1]) / 2, this.box.min.z - 0.02);
    (grid.material as THREE.Material).opacity = 0.25;
    (grid.material as THREE.Material).transparent = true;
    this.add(grid);
    for (const place of configuration.places ?? []) this.addPlace(place);
    for (const wall of configuration.world.walls ?? []) this.addWall(wall);
  }

  /** m, along the ground. */
  get across(): number {
    const size = this.box.getSize(new THREE.Vector3());
    return Math.hypot(size.x, size.y);
  }

  /** Warms places by a probability or an expected number; nothing: all are cold. */
  heat(byPlace: Map<string, number>): void {
    for (const [name, floor] of this.floors) {
      const p = Math.min(1, byPlace.get(name) ?? 0);
      floor.material.color.set(new THREE.Color(COLD).lerp(new THREE.Color(HOT), Math.sqrt(p)));
      floor.material.opacity = floor.userData.cold + (0.65 - floor.userData.cold) * Math.sqrt(p);
    }
  }

  private addPlace(place: Place): void {
    const shape = new THREE.Shape(place.polygon.map(([x, y]) => new THREE.Vector2(x, y)));
    const room = place.kind === 'room' || !place.parent;
    const z = (place.z?.[0] ?? this.box.min.z) + (room ? 0 : 0.005);
    const floor = new THREE.Mesh(
      new THREE.ShapeGeometry(shape),
      new THREE.MeshBasicMaterial({
        color: COLD, transparent: true, opacity: 0.12, side: THREE.DoubleSide, depthWrite: false,
      }),
    );
    floor.userData.cold = floor.material.opacity = room ? 0.1 : 0.28;
    floor.position.z = z;
    this.floors.set(place.name, floor);
    this.add(floor);
    const outline = new THREE.LineLoop(
      new THREE.BufferGeometry().setFromPoints(place.polygon.map(([x, y]) => new THREE.Vector3(x, y, z))),
      new THREE.LineBasicMaterial({ color: COLD }),
    );
    this.add(outline);
  }

  private addWall(wall: number[][] | { line: number[][]; z?: number[] }): void {
    const [from, to] = Array.isArray(wall) ? wall : wall.line;
    const low = Array.isArray(wall) ? this.box.min.z : (wall.z?.[0] ?? this.box.min.z);
    const high = Math.min(Array.isArray(wall) ? WALL : (wall.z?.[1] ?? WALL), low + WALL);
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const mesh = new THREE.Mesh(
      new THREE.PlaneGeometry(length, high - low),
      new THREE.MeshBasicMaterial({
        color: COLD, transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false,
      }),
    );
    mesh.rotation.order = 'ZXY';
    mesh.rotation.set(Math.PI / 2, 0, Math.atan2(to[1] - from[1], to[0] - from[0]));
    mesh.position.set((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (low + high) / 2);
    this.add(mesh);
  }
}
